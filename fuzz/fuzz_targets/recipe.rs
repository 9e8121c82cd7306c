//! Recipes: any text is refused, or gives the same recipe after writing and reading again.

#![no_main]

use microfacet_baker::scene::Scene;

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Ok(scene) = Scene::from_recipe_str(text) {
        let written = scene.to_recipe();
        let again = Scene::from_recipe_str(&written).expect("what was written is a recipe");
        assert_eq!(again.to_recipe(), written);
    }
});
