//! Times, lists and columns in the texts that commands print.

use std::borrow::Cow;
use std::path::Path;

use super::escape;

pub(super) use microfacet_report::words::{
    bytes, count, error, exact_bytes, joined, number, range,
};

/// The column at which prose in the output is wrapped.
pub(super) const COLUMNS: usize = 100;

/// A time: `12 ms`, `20.8 s`, `7.5 h`.
pub(super) fn seconds(seconds: f64) -> String {
    match seconds {
        ..0.001 => "1 ms".into(),
        ..0.9995 => format!("{:.0} ms", 1e3 * seconds),
        ..100.0 => format!("{seconds:.1} s"),
        ..7200.0 => format!("{seconds:.0} s"),
        _ => format!("{:.1} h", seconds / 3600.0),
    }
}

/// How a size or a time compares with a larger one: `53 times smaller`, or `no smaller`; words for
/// less and for more.
pub(super) fn compared(x: f64, with: f64, [less, more]: [&str; 2]) -> String {
    let (ratio, word) = if x <= with { (with / x, less) } else { (x / with, more) };
    match ratio {
        ..1.05 => format!("no {less}"),
        10.0.. => format!("{ratio:.0} times {word}"),
        _ => format!("{ratio:.1} times {word}"),
    }
}

/// A line of each of the first items, and one of all others together.
pub(super) fn first<T>(
    items: &[T],
    shown: usize,
    line: impl FnMut(&T) -> String,
    others: impl FnOnce(&[T]) -> String,
) -> String {
    let (first, more) = items.split_at(shown.min(items.len()));
    let text: String = first.iter().map(line).collect();
    if more.is_empty() { text } else { text + &others(more) }
}

/// The items without repetitions, each where it comes first.
pub(super) fn distinct<T: PartialEq>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut all = Vec::new();
    for item in items {
        if !all.contains(&item) {
            all.push(item);
        }
    }
    all
}

/// The first few of a list of names, in quotes.
pub(super) fn list<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    const SHOWN: usize = 4;
    let more = names.len().saturating_sub(SHOWN);
    let mut shown: Vec<String> =
        names.take(SHOWN).map(|name| format!("\"{}\"", escape::line(name))).collect();
    if more > 0 {
        shown.push(format!("{more} more"));
    }
    shown.join(", ")
}

/// Lines of a text that starts with `head`, broken at spaces outside quotes, with `indent` spaces
/// before all but the first.
pub(super) fn wrapped(head: &str, text: &str, indent: usize) -> String {
    let (mut lines, mut width) = (head.to_owned(), head.chars().count());
    // The head ends in its own space.
    let mut space = "";
    let mut quotes = 0;
    // Not within the quotes of a name, of which every space counts.
    let is_end = |c| {
        quotes += usize::from(c == '"');
        c == ' ' && quotes % 2 == 0
    };
    for word in text.split(is_end) {
        let more = word.chars().count();
        if width + space.len() + more > COLUMNS && width > indent {
            lines += &format!("\n{:indent$}", "");
            (width, space) = (indent, "");
        }
        lines += space;
        lines += word;
        width += space.len() + more;
        space = " ";
    }
    lines + "\n"
}

/// Rows as lines of aligned columns with two spaces between them.
pub(super) fn columns(rows: &[Vec<String>]) -> Vec<String> {
    let width = |i: usize| {
        rows.iter().filter_map(|row| row.get(i)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let widths: Vec<usize> = (0..count).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells: Vec<String> =
            row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}")).collect();
        cells.join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

/// A path as a shell reads it, to be pasted into a command.
pub(super) fn shell(path: &Path) -> String {
    let bytes = path.as_os_str().as_encoded_bytes();
    // Else it would be taken as an option.
    let dash = if bytes.starts_with(b"-") { "./" } else { "" };
    let plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"_./+:,@%-".contains(byte);
    let visible = |text: &&str| matches!(escape::line(text), Cow::Borrowed(_));
    match path.to_str().filter(visible) {
        Some(text) if !text.is_empty() && bytes.iter().all(plain) => format!("{dash}{text}"),
        Some(text) => format!("'{dash}{}'", text.replace('\'', r"'\''")),
        // Hidden characters are written by their bytes.
        None => {
            let byte = |&byte: &u8| match byte {
                b'\'' | b'\\' => format!("\\{}", char::from(byte)),
                b' '..=b'~' => char::from(byte).to_string(),
                _ => format!("\\x{byte:02x}"),
            };
            format!("$'{dash}{}'", bytes.iter().map(byte).collect::<String>())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_their_units() {
        let times = [0.0, 0.0123, 0.9994, 20.81, 320.4].map(seconds);
        assert_eq!(times, ["1 ms", "12 ms", "999 ms", "20.8 s", "320 s"]);
    }

    #[test]
    fn what_is_larger_is_called_larger() {
        let words = ["smaller", "larger"];
        assert_eq!(compared(10.0, 532.0, words), "53 times smaller");
        assert_eq!(compared(50.0, 10.0, words), "5.0 times larger");
        // Said of a size "than" another one.
        assert_eq!(compared(10.0, 10.0, words), "no smaller");
        assert_eq!(compared(10.4, 10.0, words), "no smaller");
    }

    #[test]
    fn a_text_breaks_at_spaces_before_the_edge() {
        let text = "word ".repeat(60);
        let lines = wrapped("head  ", &text, 6);
        assert!(lines.lines().all(|line| line.chars().count() <= COLUMNS), "{lines}");
        assert!(lines.lines().skip(1).all(|line| line.starts_with("      word")), "{lines}");
        assert_eq!(lines.matches("word").count(), 60);
        // A word of any length has a line to itself.
        let long = "x".repeat(150);
        assert_eq!(
            wrapped("head  ", &format!("a {long} b"), 2),
            format!("head  a\n  {long}\n  b\n")
        );
        // A name is not broken, and keeps its spaces.
        let name = format!("\"{}  b\"", "a ".repeat(30));
        assert_eq!(wrapped("", &format!("{name}, {name}"), 2), format!("{name},\n  {name}\n"));
    }

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let rows = [vec!["a".into(), "γ 3".into(), "x".into()], vec!["bcd".into(), "1".into()]];
        assert_eq!(columns(&rows), ["a    γ 3  x", "bcd  1"]);
    }

    #[test]
    fn paths_are_quoted_where_a_shell_would_split_or_expand_them() {
        let quoted = [
            ("out/glass-1.2", "out/glass-1.2"),
            ("my glass", "'my glass'"),
            ("it's", r"'it'\''s'"),
            ("$HOME", "'$HOME'"),
            ("~", "'~'"),
            ("-x", "./-x"),
            ("- x", "'./- x'"),
            ("Grüße", "'Grüße'"),
            ("a\nb'", r"$'a\x0ab\''"),
            ("", "''"),
        ];
        for (path, text) in quoted {
            assert_eq!(shell(Path::new(path)), text);
        }
    }
}
