// The switch between the colours of the system, light and dark, kept for the next visit where the
// browser allows a page from a file to keep anything.
const themes = document.querySelector('.theme');
const applyTheme = (theme) => {
    if (theme === 'system') delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = theme;
};
const keptTheme = () => {
    try {
        return localStorage.getItem('microfacet-theme');
    } catch {
        return null;
    }
};
const start = themes.querySelector(`input[value="${keptTheme() ?? 'system'}"]`);
if (start) {
    start.checked = true;
    applyTheme(start.value);
}
themes.addEventListener('change', ({ target }) => {
    applyTheme(target.value);
    try {
        localStorage.setItem('microfacet-theme', target.value);
    } catch {
        // The choice holds while the page is open.
    }
});
themes.hidden = false;
