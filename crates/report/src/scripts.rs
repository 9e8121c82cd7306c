//! The scripts of a page, and the policy by which a browser runs these and no other.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::PreEscaped;
use sha2::{Digest, Sha256};

/// The content security policy of a page that loads nothing, sends nothing, and runs these scripts.
pub(super) fn policy(scripts: &[&str]) -> String {
    let hash = |script: &&str| format!(" 'sha256-{}'", STANDARD.encode(Sha256::digest(script)));
    let hashes: String = scripts.iter().map(hash).collect();
    format!(
        "default-src 'none'; style-src 'unsafe-inline'; script-src{hashes}; img-src data:; \
         base-uri 'none'; form-action 'none'"
    )
}

/// Text of a script element, which must not contain the end of the element.
pub(super) fn verbatim(text: &str) -> PreEscaped<&str> {
    assert!(!text.contains("</"), "the program's own text ends no element");
    PreEscaped(text)
}
