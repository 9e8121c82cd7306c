//! References between materials: names, and the parts of mixtures.

use microfacet_baker::scene::{MOST_CANDIDATES, Place};

use super::Reader;
use super::definition::Definition;
use crate::builder::shortened;
use crate::references::circle;

impl Reader {
    /// Warns of names that nothing defines, and of mixtures that are parts of themselves; marks the
    /// parts of used mixtures as used.
    pub(super) fn follow_references(&mut self) {
        let mut named: Vec<(&String, usize)> =
            self.names.iter().map(|(name, &slot)| (name, slot)).collect();
        named.sort_unstable_by_key(|&(_, slot)| slot);
        let named = named.into_iter().filter(|&(_, slot)| self.slots[slot].definition.is_none());
        let named = named.map(|(name, slot)| (name, &self.slots[slot].place));
        // A name that a NamedMaterial has, too, is in `named` already.
        let parts = (0..self.slots.len()).flat_map(|slot| self.parts(slot));
        let parts = parts.filter(|(name, _)| !self.names.contains_key(*name));
        let known = self.defined.iter().filter_map(|&slot| {
            let name = &self.slots[slot].definition.as_ref()?.name;
            (self.names.get(name) == Some(&slot)).then_some(&name[..])
        });
        let known: Vec<&str> = known.take(MOST_CANDIDATES).collect();
        let undefined = named.chain(parts);
        let warnings: Vec<(Place, String)> =
            undefined.map(|(name, place)| (place.clone(), self.undefined(name, &known))).collect();
        for (place, warning) in warnings {
            self.builder.warn(&place, warning);
        }

        let inside: Vec<Vec<usize>> = (0..self.slots.len())
            .map(|slot| {
                let parts = self.parts(slot).into_iter();
                parts.filter_map(|(name, _)| self.names.get(name).copied()).collect()
            })
            .collect();
        if let Some(circle) = circle(0..inside.len(), |slot| inside[slot].clone()) {
            let definitions = circle.iter().chain(&circle[..1]);
            let definitions: Vec<&Definition> =
                definitions.filter_map(|&slot| self.slots[slot].definition.as_ref()).collect();
            let names: Vec<&str> = definitions.iter().map(|d| &d.name[..]).collect();
            let warning = format!(
                "mixtures are made of each other in a circle: {}; take one out of another",
                names.join(" -> ")
            );
            self.builder.warn(&definitions[0].place, warning);
        }
        let mut pending: Vec<usize> =
            (0..inside.len()).filter(|&slot| self.slots[slot].used).collect();
        while let Some(slot) = pending.pop() {
            for &part in &inside[slot] {
                if !std::mem::replace(&mut self.slots[part].used, true) {
                    pending.push(part);
                }
            }
        }
    }

    fn undefined(&self, name: &str, known: &[&str]) -> String {
        let name = &*shortened(name);
        if self.incomplete {
            return format!("material \"{name}\" is not defined in the files that were found");
        }
        let hint = self.builder.did_you_mean(name, known.iter().copied());
        format!("material \"{name}\" is not defined{hint}; what uses it is left out")
    }

    /// The names of the materials in a mixture; none for other classes.
    fn parts(&self, slot: usize) -> Vec<(&String, &Place)> {
        let definition = self.slots[slot].definition.as_ref();
        let mixture = definition.filter(|definition| definition.class == "mix");
        // pbrt-v3 names each of the two materials by its own parameter.
        let lists = ["materials", "namedmaterial1", "namedmaterial2"];
        let lists = lists.iter().filter_map(|list| mixture?.parameter(list));
        lists.flat_map(|list| list.values.iter().map(|name| (name, &list.place))).collect()
    }
}
