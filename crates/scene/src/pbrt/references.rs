//! References between materials: names, and the parts of mixtures.

use microfacet_baker::scene::Place;

use super::definition::Definition;
use super::syntax::Parameter;
use super::{Reader, Slot};
use crate::cycle;

impl Reader {
    /// Warns of names that nothing defines.
    pub(super) fn check_references(&mut self) {
        let undefined = |(_, slot): &(&String, &usize)| self.slots[**slot].definition.is_none();
        let mut undefined: Vec<_> = self.names.iter().filter(undefined).collect();
        undefined.sort_unstable_by_key(|&(_, &slot)| slot);
        let warnings: Vec<(Place, String)> = undefined
            .into_iter()
            .map(|(name, &slot)| (self.slots[slot].place.clone(), self.undefined(name)))
            .collect();
        for (place, warning) in warnings {
            self.builder.warn(&place, warning);
        }
    }

    fn undefined(&self, name: &str) -> String {
        if self.incomplete {
            return format!("material \"{name}\" is not defined in the files that were found");
        }
        let defined = self.names.iter().filter(|&(_, &slot)| self.slots[slot].definition.is_some());
        let hint = self.builder.did_you_mean(name, defined.map(|(name, _)| &name[..]));
        format!("material \"{name}\" is not defined{hint}; what uses it is left out")
    }

    /// Marks the parts of used mixtures as used; warns of those that nothing defines, and of
    /// mixtures that are parts of themselves.
    pub(super) fn use_parts_of_mixtures(&mut self) {
        let is_mixture = |slot: &Slot| slot.definition.as_ref().is_some_and(|d| d.class == "mix");
        let mut pending: Vec<usize> =
            (0..self.slots.len()).filter(|&i| is_mixture(&self.slots[i])).collect();
        for &slot in &pending {
            for (name, place) in self.parts(slot) {
                // One that a NamedMaterial refers to is warned of there.
                if !self.names.contains_key(&name) {
                    let warning = self.undefined(&name);
                    self.builder.warn(&place, warning);
                }
            }
        }
        let inside = |slot: usize| {
            let parts = self.parts(slot).into_iter();
            parts.filter_map(|(name, _)| self.names.get(&name).copied()).collect()
        };
        if let Some(circle) = cycle::find(pending.iter().copied(), inside) {
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
        pending.retain(|&slot| self.slots[slot].used);
        while let Some(slot) = pending.pop() {
            for (name, _) in self.parts(slot) {
                let Some(&part) = self.names.get(&name) else {
                    continue;
                };
                if !std::mem::replace(&mut self.slots[part].used, true)
                    && is_mixture(&self.slots[part])
                {
                    pending.push(part);
                }
            }
        }
    }

    /// The names of the materials in a mixture.
    fn parts(&self, slot: usize) -> Vec<(String, Place)> {
        let definition = self.slots[slot].definition.as_ref();
        let Some(mixture) = definition.filter(|definition| definition.class == "mix") else {
            return Vec::new();
        };
        // pbrt-v3 names each of them by a parameter of its own.
        let lists = ["materials", "namedmaterial1", "namedmaterial2"];
        let lists = lists.iter().filter_map(|list| mixture.parameter(list));
        let names = |p: &Parameter| {
            p.values.iter().map(|name| (name.clone(), p.place.clone())).collect::<Vec<_>>()
        };
        lists.flat_map(names).collect()
    }
}
