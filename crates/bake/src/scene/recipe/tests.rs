//! Recipes read part by part, against the same recipes read at once.

use std::path::Path;

use super::*;

#[test]
fn the_page_of_recipes_has_every_key() {
    let page = include_str!("../../../../../docs/recipe.md");
    let keys: [&[&str]; 5] =
        [&LOBE_KEYS, &MEASURED_KEYS, &FRESNEL_KEYS, &CONDUCTOR_KEYS, &RANGE_KEYS];
    for key in [&keys[..], &MATERIAL_KEYS, &HAZE_KEYS].concat().concat() {
        assert!(page.contains(&format!("`{key}`")), "docs/recipe.md: no `{key}`");
    }
}

/// What is read, or the message: part by part, and at once.
fn both(text: &str) -> [String; 2] {
    let file = Path::new("r");
    [read(text, file), read_parts(text, file, Some(0..text.len()), 100)].map(
        |outcome| match outcome {
            Ok(scene) => format!("{scene:?}"),
            Err(why) => format!("refused: {why}"),
        },
    )
}

const A: &str = "[[material]]\nname = \"a\"\nsigma = 0.3\ngamma = 3\n";
const B: &str = "  [[material]] # b\nname = \"b\"\nsigma = [0.3,\n\n 0.1]\ngamma = 3\n";

/// Texts between materials, some of them valid there.
const ODD: [&str; 33] = [
    "",
    "\u{feff}",
    "# [[material]]\n",
    "[material.fresnel]\nschlick = 0.04\n",
    "[material.haze]\nweight = 0.5\nsigma = 0.5\n",
    "[[material.fresnel]]\nschlick = 0.04\n",
    "[material]\nname = \"c\"\n",
    "[[\"material\"]]\nname = \"c\"\nsigma = 1\ngamma = 2\n",
    "[[\"\\u006daterial\"]]\nname = 'c'\nsigma = 1\ngamma = 2\n",
    "  [[\tmaterial]]\nname = 'c'\nsigma = 1\ngamma = 2\n",
    "[[material]]\r\nname = 'c'\r\nsigma = 1\r\ngamma = 2\r\n",
    "[[material]]\nname = 'a'\nsigma = 1\ngamma = 2\n",
    "[[material]]\n",
    "[[material]] x = 1\n",
    "[[material]\n",
    "[[material]]]\n",
    "[[[material]]]\n",
    "[[materials]]\nname = 'c'\n",
    "[other]\nx = 1\n",
    "material = 3\n",
    "material = []\n",
    "material = [{ name = 'c', sigma = 1, gamma = 2 }]\n",
    "material.name = 3\n",
    "name = 'twice'\n",
    "gama = 3\n",
    "masking = \"\"\"\n[[material]]\n\"\"\"\n",
    "masking = \'\'\'\n[[material]]\nname = 'c'\'\'\'\n",
    "masking = \"\"\"\n[[material]]\n",
    "masking = \"open\n",
    "theta = [0.1, # ]\n  -0.2,\n\n# [[material]]\n0.5]\n",
    "theta = [0.1, 0.2}\n",
    "masking =\n",
    "masking = \"uncorrelated\"\r",
];

/// Lists that are open where a part begins; the part before is refused for that.
const OPEN: [&str; 3] = [
    "theta = [0.1, 0.2\n",
    "theta = [0.1,\n[[material]]\n, 0.2]\n",
    "material = [\n[[material]]\n]\n",
];

#[test]
fn parts_read_as_the_whole_does() {
    let mut differ = Vec::new();
    for odd in ODD {
        let cut = &odd[..odd.char_indices().next_back().map_or(0, |(last, _)| last)];
        for text in [
            odd.to_owned(),
            format!("{odd}{A}{B}"),
            format!("{A}{odd}{B}"),
            format!("{A}{B}{odd}"),
            format!("{A}{cut}"),
            format!("{A}{B}{cut}"),
        ] {
            let [parts, whole] = both(&text);
            if parts != whole {
                differ.push(format!("{text}\n---\n{parts}\n{whole}\n"));
            }
        }
    }
    assert!(differ.is_empty(), "{}", differ.concat());
    for open in OPEN {
        let refused = both(&format!("{A}{open}{B}"));
        assert!(refused.iter().all(|why| why.starts_with("refused: ")), "{refused:?}");
    }
}

#[test]
fn the_number_of_materials_is_limited_over_all_parts() {
    let text = [A, B].concat();
    let most = |most| read_parts(&text, Path::new("r"), parts(&text), most);
    assert_eq!(most(2).unwrap().materials.len(), 2);
    let message = most(1).unwrap_err().to_string();
    assert_eq!(message, "r: the recipe has more than 1 materials; split it");
}

#[test]
fn each_header_begins_a_part() {
    let text = format!("# first\n{A}[material.fresnel]\nschlick = 1\n{B}x = \"[[material]]\"\n{A}");
    let found: Vec<&str> = parts(&text).into_iter().map(|part| &text[part]).collect();
    assert_eq!(found.len(), 3);
    assert!(found[0].ends_with("schlick = 1\n  ") && found[1].starts_with("[[material]] # b"));
    assert_eq!((found.concat(), found[2]), (text.clone(), A));
}

#[test]
fn quotes_in_comments_join_no_parts_and_headers_may_have_blanks() {
    let blanks = A.replacen("[[material]]", "[[ material\t]]", 1);
    for text in [format!("# \"\"\"\n{A}{B}"), format!("{A}# it's '''\n{B}"), format!("{B}{blanks}")]
    {
        assert_eq!(parts(&text).len(), 2, "{text}");
    }
    assert_eq!(parts(&format!("{A}x = \"#\" + \"\"\"\n{B}")).len(), 1);
}
