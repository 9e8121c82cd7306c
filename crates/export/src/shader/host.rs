//! What the program that takes a module decides: where the tables are bound, and the module's name.

use std::fmt;
use std::str::FromStr;

use super::Language;

/// The group of a binding of WGSL, the set of GLSL and SPIR-V, the space of HLSL.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// Its number.
    Number(u16),
    /// What a preprocessor replaces by it, such as `#{MATERIAL_BIND_GROUP}` of naga_oil.
    Replaced(String),
}

/// Where a program has the tables, and, of WGSL, how it imports the functions. The programs that
/// come with an export have what is theirs at the two bindings after that of the tables.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Host {
    /// The group of the tables; if absent 0, of which GLSL says nothing, as OpenGL has none.
    pub group: Option<Group>,
    /// Their binding in it.
    pub binding: u16,
    /// The name by which naga_oil imports the module.
    pub import_path: Option<String>,
    /// Whether functions take the tables, which are a texture then, as their last argument, in WGSL
    /// and GLSL: those of Metal always do.
    pub as_argument: bool,
}

impl FromStr for Group {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let name = text.strip_prefix("#{").and_then(|rest| rest.strip_suffix('}'));
        let is_name = |name: &str| {
            !name.is_empty() && name.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_')
        };
        match text.parse() {
            Ok(number) => Ok(Self::Number(number)),
            Err(_) if name.is_some_and(is_name) => Ok(Self::Replaced(text.into())),
            Err(_) => Err(format!(
                "\"{text}\" must be a whole number in [0, 65535], or, in WGSL, what a preprocessor \
                 replaces, as #{{MATERIAL_BIND_GROUP}}"
            )),
        }
    }
}

impl fmt::Display for Group {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Replaced(text) => text.fmt(f),
        }
    }
}

impl Host {
    /// Whether a language has what is asked for.
    ///
    /// # Errors
    /// What it has instead.
    pub fn check(&self, language: Language) -> Result<(), String> {
        let is_bound = self.group.is_some() || self.binding != 0;
        let can_be_argument = [Language::Wgsl, Language::Glsl, Language::GlslEs];
        match (language, &self.group) {
            _ if self.as_argument && !can_be_argument.contains(&language) => {
                Err("tables are an argument of functions in WGSL, GLSL and GLSL ES if asked for, \
                     and in Metal always: leave out --argument"
                    .into())
            }
            (Language::Wgsl, _) => Ok(()),
            _ if self.import_path.is_some() => {
                Err("only WGSL has modules with a path for imports: leave out --import-path".into())
            }
            (Language::GlslEs, _) if is_bound => {
                Err("GLSL ES has no bindings: the tables are the uniform student_t_tables, which \
                     the program gives a texture unit"
                    .into())
            }
            (Language::Msl, _) if is_bound => Err(
                "Metal has the tables as an argument of its functions, and a kernel says where \
                     they are"
                    .into(),
            ),
            (Language::Slang, _) if is_bound => Err(
                "Slang places the tables itself: write [[vk::binding(3, 1)]] before the line that \
                     declares them, and : register(t3, space1) at its end"
                    .into(),
            ),
            (_, Some(Group::Replaced(text))) => {
                Err(format!("only WGSL is preprocessed; --group {text} must be a number here"))
            }
            _ => Ok(()),
        }
    }

    /// The text of a module as this host takes it.
    pub(super) fn place(&self, text: &str, language: Language) -> String {
        let text = self.place_bindings(text, language);
        match &self.import_path {
            Some(path) => format!("#define_import_path {path}\n{text}"),
            None => text,
        }
    }

    /// The text of a module or of a program that comes with it, with the bindings that this host
    /// asks for in place of 0, 1 and 2 of no group.
    pub(super) fn place_bindings(&self, text: &str, language: Language) -> String {
        let mut text = text.to_owned();
        // From the last, so that none is replaced twice.
        for old in (0..3_u32).rev() {
            let new = u32::from(self.binding) + old;
            let [a, b] = match language {
                Language::Wgsl | Language::SpirV => {
                    let group = self.group.as_ref().map_or("0".into(), Group::to_string);
                    let at = |group: &str, binding| format!("@group({group}) @binding({binding})");
                    [at("0", old), at(&group, new)]
                }
                Language::Glsl => {
                    let set = self.group.as_ref().map(|group| format!("set = {group}, "));
                    let at = |set: &str, binding| format!("{set}binding = {binding})");
                    [at("", old), at(&set.unwrap_or_default(), new)]
                }
                Language::Hlsl => {
                    let kind = if old == 2 { "u" } else { "t" };
                    let space = self.group.as_ref().map(|group| format!(", space{group}"));
                    let [start, end] = match old {
                        0 => ["#define STUDENT_T_REGISTER ", "\n"],
                        _ => ["register(", ")"],
                    };
                    let at = |n, space: &str| format!("{start}{kind}{n}{space}{end}");
                    [at(old, ""), at(new, &space.unwrap_or_default())]
                }
                Language::GlslEs | Language::Msl | Language::Slang => return text,
            };
            text = text.replace(&a, &b);
        }
        text
    }

    /// SPIR-V with these bindings.
    pub(super) fn place_words(&self, bytes: &[u8]) -> Vec<u8> {
        const HEADER: usize = 5;
        const DECORATE: u32 = 71;
        const BINDING: u32 = 33;
        const SET: u32 = 34;
        let words = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap()));
        let mut words: Vec<u32> = words.collect();
        let mut at = HEADER;
        while at < words.len() {
            let (length, operation) = ((words[at] >> 16) as usize, words[at] & 0xffff);
            match (operation, words.get(at + 2), &self.group) {
                (DECORATE, Some(&BINDING), _) => words[at + 3] += u32::from(self.binding),
                (DECORATE, Some(&SET), Some(Group::Number(set))) => {
                    words[at + 3] = u32::from(*set);
                }
                _ => (),
            }
            at += length.max(1);
        }
        words.into_iter().flat_map(u32::to_le_bytes).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_numbers_or_what_is_replaced() {
        assert_eq!("3".parse(), Ok(Group::Number(3)));
        let name = "#{MATERIAL_BIND_GROUP}";
        assert_eq!(name.parse(), Ok(Group::Replaced(name.into())));
        for text in ["", "-1", "65536", "two", "#{}", "#{A) @binding(1}", "1.5"] {
            let why = text.parse::<Group>().unwrap_err();
            assert!(why.contains(" must ") && why.contains(text), "{why}");
        }
    }

    #[test]
    fn every_language_refuses_what_it_has_not() {
        let host = |group: &str| Host { group: group.parse().ok(), ..Host::default() };
        let path = Host { import_path: Some("student_t".into()), ..Host::default() };
        for language in [
            Language::Glsl,
            Language::GlslEs,
            Language::Hlsl,
            Language::Msl,
            Language::Slang,
            Language::SpirV,
        ] {
            assert!(Host::default().check(language).is_ok());
            assert!(path.check(language).is_err() && host("#{A}").check(language).is_err());
            let has_groups =
                ![Language::GlslEs, Language::Msl, Language::Slang].contains(&language);
            assert_eq!(host("2").check(language).is_ok(), has_groups, "{language:?}");
        }
        assert!(path.check(Language::Wgsl).is_ok() && host("#{A}").check(Language::Wgsl).is_ok());
    }

    #[test]
    fn words_of_bindings_are_changed_and_no_others() {
        let word = |length: u32, operation: u32| length << 16 | operation;
        // A header; a set and a binding of a variable, another decoration of it, and a constant
        // whose words look like a decoration.
        let words = [
            [7, 7, 7, 7, 7].as_slice(),
            &[word(4, 71), 9, 34, 0],
            &[word(4, 71), 9, 33, 2],
            &[word(3, 71), 9, 24],
            &[word(6, 43), 1, word(4, 71), 9, 33, 2],
        ];
        let bytes: Vec<u8> = words.concat().into_iter().flat_map(u32::to_le_bytes).collect();
        let host = Host { group: Some(Group::Number(3)), binding: 5, ..Host::default() };
        let placed = host.place_words(&bytes);
        let changed: Vec<(usize, u8)> = (0..bytes.len())
            .filter(|&i| bytes[i] != placed[i])
            .map(|i| (i / 4, placed[i]))
            .collect();
        assert_eq!(changed, [(8, 3), (12, 7)]);
        assert_eq!(Host::default().place_words(&bytes), bytes);
    }
}
