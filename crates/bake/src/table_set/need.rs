//! A need of a scene: tables that any process on any machine can bake by themselves.

use serde::{Deserialize, Serialize};

use microfacet_tables::Precision;

use super::group::TableGroup;
use super::job::Job;
use super::search::Search;
use super::{BakeError, Settings, Target};
use crate::cache::{self, Cache};
use crate::memory::{self, Values};
use crate::plan::Plan;
use crate::progress::Meter;
use crate::table_spec::Level;

/// A table group and its target.
///
/// A need does not depend on the others of its plan. When it was baked, the cache has its tables,
/// and a bake of the whole plan reads them from there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Need {
    target: Target,
    group: TableGroup,
}

/// The error for a text that is not of [`Need::to_text`], or of another version of this crate.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct NotANeed(String);

/// A need with the versions that its tables depend on.
#[derive(Serialize, Deserialize)]
struct Sent {
    versions: String,
    need: Need,
}

impl Need {
    /// The needs of a plan, in the order of the plan.
    ///
    /// # Errors
    /// [`BakeError::Inseparable`] for [`Target::MaxBytes`], which all tables share.
    pub fn of(plan: &Plan, target: Target) -> Result<Vec<Self>, BakeError> {
        let groups = match target {
            Target::Quality(..) => TableGroup::whole(plan)?,
            Target::MaxError(max_error) if !(max_error > 0.0) => {
                return Err(BakeError::NoError(max_error));
            }
            Target::MaxError(_) => TableGroup::apart(plan)?,
            Target::MaxBytes(_) => return Err(BakeError::Inseparable),
        };
        Ok(groups.into_iter().map(|group| Self { target, group }).collect())
    }

    /// The name of the tables in messages.
    pub fn name(&self) -> String {
        self.group.name()
    }

    /// The SHA-256, in hexadecimal, of all that its tables depend on: equal for needs of the same
    /// tables, in any scene and on any machine with the same version.
    pub fn id(&self) -> String {
        let key = match self.target {
            Target::Quality(quality, precision) => self.group.key(quality.into(), precision),
            _ => format!("{:?} {}", self.target, self.group.key(Level::DEFAULT, Precision::F32)),
        };
        cache::sha256(&cache::complete(&key))
    }

    /// Estimated seconds of one thread, the same number on every machine; for [`Target::MaxError`]
    /// those of default quality.
    pub fn seconds(&self) -> f64 {
        self.group.work(self.target.quality().into(), 1)
    }

    /// Whether a cache has the finished tables, undamaged; always `false` for [`Target::MaxError`],
    /// where it would take a search to tell.
    pub fn is_kept(&self, cache: &Cache) -> bool {
        match self.target {
            Target::Quality(quality, precision) => {
                let level = quality.into();
                let kept = cache.get(&self.group.key(level, precision));
                kept.is_some_and(|tables| self.group.asks_for(&tables, level, precision))
            }
            _ => false,
        }
    }

    /// Announces the work of [`bake`](Self::bake).
    pub fn announce(&self, progress: &Meter) {
        // A search announces its steps one by one.
        if let Target::Quality(quality, _) = self.target {
            progress.expect(self.group.work(quality.into(), 1));
        }
    }

    /// Bakes the tables that `settings.cache` lacks, and keeps them there. Returns whether any had
    /// to be baked.
    ///
    /// # Errors
    /// [`BakeError`] for tables that cannot be made within the settings, or not cached.
    pub fn bake(&self, settings: Settings) -> Result<bool, BakeError> {
        let mut job = Job::new(settings);
        let tables = match self.target {
            Target::Quality(quality, precision) => {
                let level = quality.into();
                memory::check(Values::at_once([self.group.values(level)]), job.max_memory)?;
                self.group.bake(level, &[precision], &mut job)?.concat()
            }
            Target::MaxError(max_error) => {
                // A shard has no limit of time.
                job.patient = true;
                Search::new(vec![self.group.clone()]).meeting(max_error, &mut job)?
            }
            Target::MaxBytes(_) => return Err(BakeError::Inseparable),
        };
        match job.cache_error.take() {
            Some(why) => Err(BakeError::NotKept(why)),
            None => Ok(job.baked_of(&tables) > 0),
        }
    }

    /// The need as text, for another machine.
    pub fn to_text(&self) -> String {
        let sent = Sent { versions: cache::versions(), need: self.clone() };
        toml::to_string(&sent).expect("needs are tables of numbers and names")
    }

    /// The need that [`to_text`](Self::to_text) wrote.
    ///
    /// # Errors
    /// [`NotANeed`] for any other text, and for one of another version, whose tables would differ.
    pub fn from_text(text: &str) -> Result<Self, NotANeed> {
        #[derive(Deserialize)]
        struct Head {
            versions: String,
        }
        let not = |why: toml::de::Error| NotANeed(format!("not a need: {}", why.message()));
        let Head { versions } = toml::from_str(text).map_err(not)?;
        let ours = cache::versions();
        if versions != ours {
            return Err(NotANeed(format!(
                "the need is of {versions}, and this is {ours}: install the same version on all \
                 machines"
            )));
        }
        Ok(toml::from_str::<Sent>(text).map_err(not)?.need)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{AlbedoWish, Options};
    use crate::scene::Scene;
    use crate::table_spec::Quality;

    const RECIPE: &str = "
        [[material]]
        name = \"brushed\"
        sigma = [0.1, 0.3]
        gamma = 2.7182818284590455
        fresnel = \"mirror\"
        [[material]]
        name = \"tilted\"
        sigma = [0.2, 0.3]
        theta = [0.1, -0.2, 0.5]
        gamma = \"inf\"
        [[material]]
        name = \"range\"
        sigma = { min = 0.1, max = 0.3 }
        gamma = { min = 1.6, max = \"inf\" }
        fresnel = { dielectric = { min = 1.3, max = 1.6 } }
        masking = \"uncorrelated\"
        [[material]]
        name = \"gauss\"
        distribution = \"gauss\"
        m = 0.3
        fresnel = { conductor = { eta = [0.2, 0.4, 1.3], k = [3.9, 2.4, 2.2] } }
    ";

    fn needs(target: Target) -> Vec<Need> {
        let scene = Scene::from_recipe_str(RECIPE).unwrap();
        let options = Options { albedo: AlbedoWish::All, ..Options::default() };
        Need::of(&Plan::new(&scene, options).unwrap(), target).unwrap()
    }

    #[test]
    fn a_need_is_the_same_after_a_journey() {
        let targets =
            [Target::Quality(Quality::Draft, Precision::U16), Target::MaxError(1.0 / 3.0)];
        for target in targets {
            let all = needs(target);
            assert!(all.len() > 6, "{}", all.len());
            for need in &all {
                let read = Need::from_text(&need.to_text()).unwrap();
                assert_eq!((&read, read.id()), (need, need.id()));
                assert!(need.seconds() > 0.0, "{}", need.name());
            }
            let ids: std::collections::HashSet<String> = all.iter().map(Need::id).collect();
            assert_eq!(ids.len(), all.len());
        }
        let draft = needs(Target::Quality(Quality::Draft, Precision::F32));
        assert_ne!(draft[0].id(), needs(targets[0])[0].id());
    }

    #[test]
    fn a_need_of_another_version_is_refused() {
        let text = needs(Target::default())[0].to_text();
        let other = text.replacen("numerics ", "numerics 9", 1);
        let why = Need::from_text(&other).unwrap_err().to_string();
        assert!(why.contains("numerics 9") && why.contains("same version"), "{why}");
        assert!(Need::from_text("sigma = 1").is_err() && Need::from_text("[").is_err());
        let none = Need::of(&Plan::general(), Target::MaxBytes(1));
        assert!(matches!(none, Err(BakeError::Inseparable)));
    }
}
