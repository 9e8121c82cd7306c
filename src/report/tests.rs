//! Whole pages: how large they are, and what names they bear.

use microfacet_sampler::{MaterialEntry, Tables};

use super::subjects::Subjects;
use super::{Source, overview, page};
use crate::plan::{Options, Plan};
use crate::progress::Meter;
use crate::scene::Scene;
use crate::table_set::{Target, bake};
use crate::table_spec::Quality;
