//! What the shards of a library leave in their cache: which are done, and of what.
//!
//! Tables in a cache are never out of date, since their names are made of all that they depend on.
//! But a shard of another state of the scene, or of another version, is of no use, and whoever
//! waits for the set wants to hear of it before a week is lost.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::{fs, io};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::Shard;
use crate::cache::versions;
use crate::input::{self, MAX_TEXT};
use crate::store::{in_folder, make_folder, replace};
use crate::table_set::Need;

/// The folder of receipts in that of a cache.
const FOLDER: &str = "shards";

/// That a shard is done.
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
    /// The receipt of a shard of these needs, all those of the library.
    pub fn new(scene: &Path, shard: Shard, needs: &[(String, Need)]) -> Self {
        Self {
            scene: scene.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            shard: shard.number,
            of: shard.of,
            versions: versions(),
            needs: hex(Sha256::digest(
                needs.iter().flat_map(|(id, _)| [id, "\n"]).collect::<String>(),
            )),
        }
    }

    /// Whether both are of the same needs, made by the same version.
    fn is_same(&self, other: &Self) -> bool {
        self.needs == other.needs && self.versions == other.versions
    }

    /// Leaves it in a cache, in the place of an older one of the same shard and needs.
    ///
    /// # Errors
    /// Those of the operating system, with the path.
    pub fn leave(&self, cache: &Path) -> io::Result<()> {
        let at = |path: &Path, why: io::Error| {
            io::Error::new(why.kind(), format!("{}: {why}", path.display()))
        };
        let folder = cache.join(FOLDER);
        make_folder(&folder).map_err(|why| at(&folder, why))?;
        // Libraries of the same file name, and states of one, may share a cache.
        let Self { scene, shard, of, versions, needs } = self;
        let library = &hex(Sha256::digest(format!("{scene}\n{versions}\n{needs}")))[..16];
        let path = folder.join(format!("{library}-{shard}-of-{of}.json"));
        let json = serde_json::to_string_pretty(self).map_err(io::Error::other)?;
        let json = json + "\n";
        in_folder(&folder, || replace(&path, json.as_bytes())).map_err(|why| at(&path, why))
    }
}

fn hex(bytes: impl AsRef<[u8]>) -> String {
    bytes.as_ref().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The receipts of a scene that a cache holds.
#[derive(Debug, Default)]
pub struct Receipts {
    all: Vec<Receipt>,
    unread: Vec<PathBuf>,
}

impl Receipts {
    /// Those of the scene's file name; none if the folder cannot be read.
    pub fn read(cache: &Path, scene: &Path) -> Self {
        let mut found = Self::default();
        let Ok(folder) = fs::read_dir(cache.join(FOLDER)) else { return found };
        let mut paths: Vec<PathBuf> = folder.flatten().map(|entry| entry.path()).collect();
        paths.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
        paths.sort();
        for path in paths {
            let text = input::read_text(&path, MAX_TEXT).ok();
            let receipt = text.and_then(|text| serde_json::from_str::<Receipt>(&text).ok());
            // Of 9e18 shards not even the missing ones could be listed.
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

    /// Why tables may be missing where the set is assembled: nothing if there are no receipts, or
    /// if all shards of some number are done. `ours` is the receipt of the library as it is now, of
    /// any shard.
    pub fn doubts(&self, ours: &Receipt) -> Vec<String> {
        let is_same = |receipt: &&Receipt| receipt.is_same(ours);
        let counts = self.all.iter().filter(is_same).map(|receipt| receipt.of);
        let done =
            |of: usize| self.all.iter().filter(is_same).filter(move |receipt| receipt.of == of);
        // Of the number of shards with the most done.
        let best = counts.max_by_key(|&of| (done(of).count(), of));
        if best.is_some_and(|of| done(of).count() == of) {
            return Vec::new();
        }
        let mut doubts = Vec::new();
        if let Some(of) = best {
            let ended: HashSet<usize> = done(of).map(|receipt| receipt.shard).collect();
            let missing: Vec<usize> = (1..=of).filter(|i| !ended.contains(i)).collect();
            doubts.push(format!(
                "{} of {of} shards {} not ended: {}",
                missing.len(),
                if missing.len() == 1 { "has" } else { "have" },
                listed(&missing)
            ));
        }
        doubts.extend(self.strangers(ours));
        doubts
    }

    /// What to say of those that are of another state of the scene, of other options or of another
    /// version.
    pub fn strangers(&self, ours: &Receipt) -> Vec<String> {
        let mut doubts = Vec::new();
        let (stale, foreign): (Vec<&Receipt>, Vec<&Receipt>) = self
            .all
            .iter()
            .filter(|receipt| !receipt.is_same(ours))
            .partition(|receipt| receipt.versions == ours.versions);
        let shards = |receipts: &[&Receipt]| {
            let names: Vec<String> =
                receipts.iter().map(|r| format!("{}/{}", r.shard, r.of)).collect();
            let names = listed(&names);
            if receipts.len() == 1 {
                format!("shard {names} is")
            } else {
                format!("shards {names} are")
            }
        };
        if !stale.is_empty() {
            doubts.push(format!(
                "{} of another state of {}, or of other options",
                shards(&stale),
                ours.scene
            ));
        }
        if let Some(first) = foreign.first() {
            doubts.push(format!(
                "{} of another version ({}; this is {}), whose tables are not used",
                shards(&foreign),
                first.versions,
                ours.versions
            ));
        }
        let unread = self
            .unread
            .iter()
            .map(|path| format!("{}: not a receipt of a shard; remove it", path.display()));
        doubts.extend(unread);
        doubts
    }
}

/// The first few of a list.
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
        // Those of last week do not matter once all are done.
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
        // Another library of the same name takes no receipt away.
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
        // Shards that cannot be.
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
