//! Makes the names of materials unique.

use std::collections::HashMap;

/// How often each name was given.
#[derive(Debug, Default)]
pub struct Names(HashMap<String, usize>);

impl Names {
    /// The name itself the first time, then "name (2)" and so on.
    pub fn unique(&mut self, name: String) -> String {
        let count = self.0.entry(name.clone()).or_default();
        *count += 1;
        if *count == 1 {
            return name;
        }
        let numbered = format!("{name} ({count})");
        self.unique(numbered)
    }
}
