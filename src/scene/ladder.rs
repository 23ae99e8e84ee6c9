//! One effect after another: first only touching, then the additions of each line of a scene.

use super::SceneError;
use super::file::{Effects, Scene, Want};

/// A scene with more and more of its demands, each named after the last addition. The first asks only for touching, and
/// the last is the whole scene.
///
/// # Errors
/// Returns the errors of [`Scene::switched`].
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
    // Effects that need no part of the AFU add nothing to it, and the table shows this.
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
