//! Makes text from files safe to show: names in a scene or a table file may hold characters that
//! control a terminal, that reverse the order of text, or that are not seen.

use std::borrow::Cow;

/// A text of several lines, with every hidden character written out, as `\u{1b}`.
pub fn lines(text: &str) -> Cow<'_, str> {
    escaped(text, |c| is_hidden(c) && !matches!(c, '\n' | '\t'), char::escape_unicode)
}

/// A text of one line, with hidden characters and line breaks written out.
pub fn line(text: &str) -> Cow<'_, str> {
    escaped(text, is_hidden, char::escape_default)
}

/// A JSON document with hidden characters as escapes of JSON; they occur in its strings alone.
pub fn json(text: &str) -> Cow<'_, str> {
    // None is above U+FFFF, where JSON needs pairs.
    let hidden = |c: char| is_hidden(c) && c != '\n';
    escaped(text, hidden, |c| format!("\\u{:04x}", u32::from(c)).chars().collect::<Vec<_>>())
}

/// A string of TOML or JSON with its quotes, as which it reads back.
pub fn string(text: &str) -> String {
    json(&serde_json::Value::from(text).to_string()).into_owned()
}

fn escaped<I: IntoIterator<Item = char>>(
    text: &str,
    hidden: impl Fn(char) -> bool,
    escape: impl Fn(char) -> I,
) -> Cow<'_, str> {
    if !text.contains(&hidden) {
        return text.into();
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if hidden(c) {
            shown.extend(escape(c));
        } else {
            shown.push(c);
        }
    }
    shown.into()
}

/// Control characters, breaks of lines, controls of the direction of writing, and characters
/// without a width, which make different names look the same.
fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{feff}')
        || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}')
}

#[cfg(test)]
mod tests {
    use super::*;

    const ODD: &str = "é\u{1b}[31m\r\n\t\u{7}\u{7f}\u{9b}2J\u{202e}\u{2066}\u{2028}∞";

    #[test]
    fn what_commands_a_terminal_is_written_out() {
        let rest = r"\u{7}\u{7f}\u{9b}2J\u{202e}\u{2066}\u{2028}∞";
        assert_eq!(lines(ODD), format!("é\\u{{1b}}[31m\\u{{d}}\n\t{rest}"));
        assert_eq!(line(ODD), format!("é\\u{{1b}}[31m\\r\\n\\t{rest}"));
        assert!(matches!(lines("plain, é ∞\n"), Cow::Borrowed(_)));
    }

    #[test]
    fn characters_without_a_width_are_written_out() {
        let name = "go\u{200b}ld\u{feff}\u{200d}\u{2060}\u{ad}";
        let shown = r"go\u{200b}ld\u{feff}\u{200d}\u{2060}\u{ad}";
        assert_eq!((lines(name), line(name)), (shown.into(), shown.into()));
        assert_eq!(json(name), r"go\u200bld\ufeff\u200d\u2060\u00ad");
    }

    #[test]
    fn a_string_reads_back_as_toml_and_as_json() {
        let text = string(ODD);
        assert!(!text.contains(is_hidden) && text.contains(r"\u202e\u2066\u2028∞"), "{text}");
        assert_eq!(serde_json::from_str::<String>(&text).unwrap(), ODD);
        assert_eq!(
            toml::from_str::<toml::Table>(&format!("a = {text}")).unwrap()["a"].as_str(),
            Some(ODD)
        );
    }

    #[test]
    fn json_reads_back() {
        let document = serde_json::json!({ "name": ODD });
        let text = format!("{document:#}");
        let shown = json(&text);
        assert!(shown.chars().all(|c| c == '\n' || !is_hidden(c)), "{shown}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&shown).unwrap(), document);
    }
}
