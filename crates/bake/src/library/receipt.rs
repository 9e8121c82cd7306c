//! Receipts of the shards of a library in their cache. They tell which shards are done, and whether
//! a shard is of another state of the scene or of another version, so that its tables are not used.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::{fs, io};

use serde::{Deserialize, Serialize};

use super::Shard;
use crate::cache::{sha256, versions, write_in};
use crate::input::{self, MAX_TEXT};
use crate::table_set::Need;

/// The folder of receipts in that of a cache.
const FOLDER: &str = "shards";

/// States that a shard is done.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Receipt {
    /// The name of the scene's file.
    pub scene: String,
    /// The shard's number.
    pub shard: usize,
    /// The number of shards.
    pub of: usize,
    /// The versions that tables depend on.
    pub versions: String,
    /// The SHA-256 of all needs of the library.
    pub needs: String,
}

impl Receipt {
    /// The receipt of a shard; `needs` are all those of the library.
    pub fn new(scene: &Path, shard: Shard, needs: &[(String, Need)]) -> Self {
        Self {
            scene: scene.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            shard: shard.number,
            of: shard.of,
            versions: versions(),
            needs: sha256(&needs.iter().flat_map(|(id, _)| [id, "\n"]).collect::<String>()),
        }
    }

    /// Whether both are of the same needs and of the same version.
    fn is_same(&self, other: &Self) -> bool {
        self.needs == other.needs && self.versions == other.versions
    }

    /// Writes it into a cache; an older receipt of the same shard and needs is replaced.
    ///
    /// # Errors
    /// Those of the operating system, with the path.
    pub fn leave(&self, cache: &Path) -> io::Result<()> {
        // Libraries of the same file name, and states of one library, may share a cache.
        let Self { scene, shard, of, versions, needs } = self;
        let library = &sha256(&format!("{scene}\n{versions}\n{needs}"))[..16];
        let json = serde_json::to_string_pretty(self).map_err(io::Error::other)? + "\n";
        let name = format!("{library}-{shard}-of-{of}.json");
        write_in(&cache.join(FOLDER), &name, json.as_bytes())
    }
}

/// The receipts of a scene that a cache holds.
#[derive(Debug, Default)]
pub struct Receipts {
    all: Vec<Receipt>,
    unread: Vec<PathBuf>,
}

impl Receipts {
    /// The receipts of the scene's file name; none if the folder cannot be read.
    pub fn read(cache: &Path, scene: &Path) -> Self {
        let mut found = Self::default();
        let Ok(folder) = fs::read_dir(cache.join(FOLDER)) else { return found };
        let mut paths: Vec<PathBuf> = folder.flatten().map(|entry| entry.path()).collect();
        paths.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
        paths.sort();
        for path in paths {
            let text = input::read_text(&path, MAX_TEXT).ok();
            let receipt = text.and_then(|text| serde_json::from_str::<Receipt>(&text).ok());
            // A file may state any number of shards; without a limit, the list of missing ones
            // might exceed the memory.
            let exists =
                |receipt: &Receipt| Shard { number: receipt.shard, of: receipt.of }.exists();
            match receipt.filter(exists) {
                Some(receipt) if scene.file_name().is_some_and(|name| *name == *receipt.scene) => {
                    found.all.push(receipt);
                }
                Some(_) => {}
                None => found.unread.push(path),
            }
        }
        found.all.sort_by_key(|receipt| (receipt.of, receipt.shard));
        found
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty() && self.unread.is_empty()
    }

    /// Whether any shard of the same library, in the same state, is done.
    pub fn has(&self, ours: &Receipt) -> bool {
        self.all.iter().any(|receipt| receipt.is_same(ours))
    }

    /// Why tables may be missing when the set is assembled: nothing if there are no receipts, or if
    /// all N shards are done for some N. `ours` is the receipt of any shard of the library as it is
    /// now.
    pub fn doubts(&self, ours: &Receipt) -> Vec<String> {
        let mut ended: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        for receipt in self.all.iter().filter(|receipt| receipt.is_same(ours)) {
            ended.entry(receipt.of).or_default().insert(receipt.shard);
        }
        let mut doubts = Vec::new();
        // The N of which the most shards are done.
        if let Some((&of, ended)) = ended.iter().max_by_key(|(of, ended)| (ended.len(), **of)) {
            let missing: Vec<usize> = (1..=of).filter(|i| !ended.contains(i)).collect();
            let have = match missing.len() {
                0 => return Vec::new(),
                1 => "has",
                _ => "have",
            };
            let (count, missing) = (missing.len(), listed(&missing));
            doubts.push(format!("{count} of {of} shards {have} not ended: {missing}"));
        }
        doubts.extend(self.others(ours));
        doubts
    }

    /// Messages on receipts of another state of the scene, of other options or of another version,
    /// and on files that are no receipts.
    pub fn others(&self, ours: &Receipt) -> Vec<String> {
        let others = self.all.iter().filter(|receipt| !receipt.is_same(ours));
        let (stale, foreign): (Vec<&Receipt>, Vec<&Receipt>) =
            others.partition(|receipt| receipt.versions == ours.versions);
        let shards = |receipts: &[&Receipt]| {
            let names = receipts.iter().map(|of| format!("{}/{}", of.shard, of.of));
            let names = listed(&names.collect::<Vec<_>>());
            match receipts {
                [_] => format!("shard {names} is"),
                _ => format!("shards {names} are"),
            }
        };
        let mut doubts = Vec::new();
        if !stale.is_empty() {
            let (shards, scene) = (shards(&stale), &ours.scene);
            doubts.push(format!("{shards} of another state of {scene}, or of other options"));
        }
        if let Some(first) = foreign.first() {
            doubts.push(format!(
                "{} of another version ({}; this is {}), whose tables are not used",
                shards(&foreign),
                first.versions,
                ours.versions
            ));
        }
        let unread = self.unread.iter().map(|path| path.display());
        doubts.extend(unread.map(|path| format!("{path}: not a receipt of a shard; remove it")));
        doubts
    }
}

/// The first eight of a list, and the number of the others.
fn listed(all: &[impl ToString]) -> String {
    const SHOWN: usize = 8;
    let mut names: Vec<String> = all.iter().take(SHOWN).map(ToString::to_string).collect();
    if all.len() > SHOWN {
        names.push(format!("{} more", all.len() - SHOWN));
    }
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn receipt(shard: usize, of: usize, needs: &str) -> Receipt {
        let scene = Path::new("some/where/lib.toml");
        let receipt = Receipt::new(scene, Shard { number: shard, of }, &[]);
        Receipt { needs: needs.into(), ..receipt }
    }

    fn said(receipts: &[Receipt]) -> String {
        let cache = tempfile::tempdir().unwrap();
        receipts.iter().for_each(|receipt| receipt.leave(cache.path()).unwrap());
        let found = Receipts::read(cache.path(), Path::new("lib.toml"));
        found.doubts(&receipt(1, 1, "now")).join("; ")
    }

    #[test]
    fn what_shards_left_is_said() {
        assert_eq!(said(&[]), "");
        assert_eq!(said(&[receipt(1, 2, "now"), receipt(2, 2, "now")]), "");
        // Older receipts do not matter once all shards are done.
        let all = [receipt(1, 2, "now"), receipt(2, 2, "now"), receipt(3, 4, "before")];
        assert_eq!(said(&all), "");
        let lost = said(&[receipt(2, 3, "now"), receipt(3, 3, "now")]);
        assert_eq!(lost, "1 of 3 shards has not ended: 1");
        let changed = said(&[receipt(1, 2, "before"), receipt(2, 2, "now")]);
        assert_eq!(
            changed,
            "1 of 2 shards has not ended: 1; shard 1/2 is of another state of lib.toml, or of other \
             options"
        );
        assert_eq!(said(&[receipt(1, 1, "before"), receipt(1, 1, "now")]), "");
        // Another library of the same name replaces no receipt.
        assert_eq!(said(&[receipt(1, 1, "now"), receipt(1, 1, "other")]), "");
        let other = Receipt { versions: "numerics 5".into(), ..receipt(1, 1, "now") };
        assert!(said(&[other]).contains("shard 1/1 is of another version (numerics 5; this is"));
        let elsewhere = Receipt { scene: "other.toml".into(), ..receipt(1, 2, "before") };
        assert_eq!(said(&[elsewhere]), "");
    }

    #[test]
    fn what_is_no_receipt_is_named() {
        let cache = tempfile::tempdir().unwrap();
        receipt(1, 2, "now").leave(cache.path()).unwrap();
        let write = |name: &str, text: &str| {
            fs::write(cache.path().join(FOLDER).join(name), text).unwrap();
        };
        write("odd.json", "{");
        // Shards that cannot exist.
        for (shard, of) in [(1, 9_000_000_000_000_000_000), (3, 2), (0, 2), (0, 0)] {
            let never = Receipt { shard, of, ..receipt(1, 1, "now") };
            write(&format!("{shard}-{of}.json"), &serde_json::to_string(&never).unwrap());
        }
        let found = Receipts::read(cache.path(), Path::new("lib.toml"));
        let said = found.doubts(&receipt(1, 1, "now"));
        assert!(said.len() == 6 && said.concat().contains("odd.json"), "{said:?}");
        assert_eq!(said[0], "1 of 2 shards has not ended: 2");
    }
}
