//! One effect after another: touching alone, then what each line of a scene adds.

use super::SceneError;
use super::file::{Effects, Scene, Want};

/// A scene with more and more of what it calls for, by the name of what was added last. The first asks for touching
/// alone, the last is the scene's own.
///
/// # Errors
/// None that [`Scene::switched`] does not give.
pub fn ladder(scene: &Scene) -> Result<Vec<(String, Scene)>, SceneError> {
    let of_fields = [Want::Depth, Want::Normals, Want::ContactPoints];
    let mut bare = scene.clone();
    bare.effects = Effects::default();
    bare.want = vec![(Want::Touching, 0)];
    (bare.accuracy, bare.max_error) = (None, None);
    let mut rungs = vec![("touching alone".to_owned(), bare.clone())];
    for want in of_fields {
        if let Some(wanted) = scene.want.iter().find(|(wanted, _)| *wanted == want) {
            bare.want.push(*wanted);
            rungs.push((want.name().to_owned(), bare.clone()));
        }
    }
    // Effects that call for no part of the AFU add nothing to it, and the table shows that.
    let names = Scene::effect_names();
    for (place, name) in names.iter().enumerate() {
        if scene.switched(name, false)?.effects == scene.effects {
            continue;
        }
        let mut so_far = scene.clone();
        for later in &names[place + 1..] {
            so_far = so_far.switched(later, false)?;
        }
        bare.effects = so_far.effects;
        rungs.push(((*name).to_owned(), bare.clone()));
    }
    if scene.accuracy.is_some() || scene.max_error.is_some() {
        rungs.push(("accuracy".to_owned(), scene.clone()));
    }
    Ok(rungs)
}
