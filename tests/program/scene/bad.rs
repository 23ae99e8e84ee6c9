//! Invalid scenes give one clear error that names file, line and key.

use contact_afu::scene::{Plan, Scene, check_start};

const GOOD: &str =
    "scene = 1\nwant = [\"touching\"]\n[effects]\nbounce = 0.5\n[[bodies]]\nshape = \"stack\"\ncount = 3\n";

#[test]
fn each_is_one_error_with_line_and_key() {
    Scene::parse("s.toml", GOOD).expect("the text that is spoiled is a scene");
    for (from, to, expected) in [
        ("scene = 1", "scene = 2", "s.toml:1: scene: version 2 is not known"),
        ("scene = 1", "scene = 1\ncolour = 3", "s.toml:2: unknown field `colour`"),
        ("bounce = 0.5", "bounce = 1.5", "s.toml:4: bounce: 1.5 is not from 0 to 1"),
        ("bounce = 0.5", "bounce = nan", "s.toml:4: bounce: NaN is not from 0 to 1"),
        ("bounce = 0.5", "jelly = 0.5", "s.toml:4: unknown field `jelly`"),
        ("bounce = 0.5", "gravity = [0.0, 0.0, inf]", "s.toml:4: gravity: inf is not from"),
        ("bounce = 0.5", "walls = [[1, 1, 1], [0, 2, 2]]", "s.toml:4: walls: the first corner"),
        ("count = 3", "count = 3\nmass = nan", "s.toml:8: mass: NaN is not from"),
        ("count = 3", "count = 3\nradius = 0.0", "s.toml:8: radius: 0 is not from"),
        (
            "count = 3",
            "count = 1_000_000_000",
            "s.toml:5: bodies: expected at most 1000000 spheres in total, found 1000000000",
        ),
        (
            "count = 3\n",
            "count = 3\n[[queries]]\nshape = \"lattice\"\ncount = [9_000_000_000_000_000_000, 9, 9]\n",
            "s.toml:8: queries: expected at most 1000000 spheres in total, found 18446744073709551615",
        ),
        ("count = 3", "count = 0", "s.toml:6: bodies: there is no body in it"),
        ("count = 3", "count = 3\nlayers = 2", "s.toml:8: layers: a stack has none"),
        ("count = 3", "count = 3\nturning = [1.0, 0.0, 0.0]", "s.toml:8: turning: bodies do not turn without"),
        ("\"stack\"", "\"pile\"", "s.toml:6: shape: there is no `pile`: use diamond, lattice"),
        ("count = 3\n", "", "s.toml:6: shape: a shape of this kind needs `count`"),
        ("[\"touching\"]", "[]", "s.toml:1: want: nothing is wanted"),
        ("[\"touching\"]", "[\"energy\"]", "s.toml:2: want: energy of bodies that nothing moves"),
        ("[\"touching\"]", "[\"mass\"]", "s.toml:2: unknown variant `mass`"),
        (
            "want",
            "accuracy = \"wide\"\nmax_error = 1e-3\nwant",
            "s.toml:3: max_error: accuracy names a profile already",
        ),
        ("want", "accuracy = \"superb\"\nwant", "s.toml:2: accuracy:"),
        ("want", "steps = 0\nwant", "s.toml:2: steps: give 1 to 10 million"),
        ("want", "scpus = 65\nwant", "s.toml:2: scpus: expected 1 to 64"),
        ("[[bodies]]\nshape = \"stack\"\ncount = 3\n", "", "s.toml:1: bodies: there are none"),
        (
            "count = 3\n",
            "count = 3\nvelocity = [1.0, 0, 0]\n[[queries]]\nshape = \"stack\"\ncount = 1\n",
            "s.toml:9: queries:",
        ),
        ("count = 3\n", "count = [", "s.toml:7: "),
    ] {
        let text = GOOD.replacen(from, to, 1);
        assert_ne!(text, GOOD, "{from}");
        let error = Scene::parse("s.toml", &text).expect_err(to).to_string();
        assert!(error.starts_with(expected), "{to}: {error}");
        assert!(!error.contains('\n'), "{error}");
    }
}

#[test]
fn moving_bodies_are_fewer_and_files_say_what_is_wrong_in_them() {
    let moving = GOOD.replace("count = 3", "count = 20_001\nvelocity = [1.0, 0.0, 0.0]");
    let error = Scene::parse("s.toml", &moving).expect_err("too many").to_string();
    assert!(error.contains("expected at most 20000 moving spheres in total"), "{error}");

    let folder = tempfile::tempdir().unwrap();
    let points = folder.path().join("points.csv");
    let scene = folder.path().join("s.toml");
    std::fs::write(&scene, GOOD.replace("\"stack\"\ncount = 3", "\"file\"\nfile = \"points.csv\"")).unwrap();
    for (text, expected) in [
        ("x,y,z,r\n0,0,0,1\n0,0,zero,1\n", "points.csv:3: z is `zero`: not a number"),
        ("x,y,z,r\n0,0,0,-1\n", "points.csv:2: radius -1: give one above 0"),
        ("x,y,z\n0,0\n", "points.csv:2: z is missing"),
        ("x,y,z\n0,0,1e30\n", "points.csv:2: z is 1"),
        ("a,b\n1,2\n", "points.csv:1: no columns x, y, z"),
        ("x,y,z\n", "has no sphere"),
        ("ply\nformat binary_little_endian 1.0\n", "points.csv:2: format binary_little_endian"),
        ("ply\nformat ascii 1.0\nelement vertex many\n", "points.csv:3: `many` is no count"),
    ] {
        std::fs::write(&points, text).unwrap();
        let read = Scene::read(&scene).expect("the scene itself is one");
        let error = contact_afu::scene::Still::of(&read).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}");
    }
    std::fs::write(&points, "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 1\n0 0 2.5\n").unwrap();
    let query = contact_afu::scene::Still::of(&Scene::read(&scene).unwrap()).unwrap();
    assert_eq!(query.balls.iter().map(|ball| ball.centre[2]).collect::<Vec<_>>(), [1.0, 2.5]);
}

/// If `at` is mistaken for a lattice's corner, the lattice lies half below the floor. That is rejected unless the file
/// allows it.
#[test]
fn bodies_that_begin_inside_something_are_counted_and_refused() {
    let lattice = "scene = 1\nwant = [\"energy\"]\n[effects]\ngravity = [0.0, 0.0, -9.81]\nfloor = 0.0\nbounce = 0.5\n\
                   [[bodies]]\nshape = \"lattice\"\ncount = [2, 2, 4]\nradius = 0.5\nat = [0.5, 0.5, 0.5]\n";
    let check = |text: &str| {
        let scene = Scene::parse("s.toml", text).unwrap();
        check_start(&scene, &Plan::of(&scene).unwrap()).map_err(|error| error.to_string())
    };
    let cure = "move them (`at` is the middle of a diamond or a lattice, not its corner), or allow it with start = \"as given\"";
    let below = "8 bodies begin below the floor, the first body 0 (line 7) by 1.50";
    assert_eq!(check(lattice), Err(format!("s.toml:7: bodies: {below}; {cure}")));
    assert_eq!(check(&lattice.replace("scene = 1\n", "scene = 1\nstart = \"as given\"\n")), Ok(()));
    assert_eq!(check(&lattice.replace("0.5, 0.5, 0.5]", "0.5, 0.5, 2.0]")), Ok(()), "they touch, and no more");

    let walls = lattice.replace("floor = 0.0", "walls = [[-0.5, -0.5, -2.0], [1.5, 1.5, 2.0]]");
    let outside = "4 bodies begin outside the walls, the first body 3 (line 7) by 0.500";
    assert_eq!(check(&walls), Err(format!("s.toml:7: bodies: {outside}; {cure}")));
    // Two groups, one of which overlaps the other, and a body inside both.
    let second = "[[bodies]]\nshape = \"stack\"\ncount = 2\nradius = 0.25\nat = [0.1, 0.0, 2.3]\n";
    let two = format!("{}{second}", lattice.replace("0.5, 0.5, 0.5]", "0.5, 0.5, 2.0]"));
    let inside =
        "3 pairs of bodies begin inside one another, the first body 2 (line 7) and body 16 (line 12) by 0.526; ";
    let error = check(&two).unwrap_err();
    assert!(error.starts_with(&format!("s.toml:7: bodies: {inside}")), "{error}");
    // If no effect separates bodies, they may overlap. A query looks for overlaps.
    assert_eq!(check(&two.replace("bounce = 0.5\n", "")), Ok(()));
    let query = "scene = 1\nwant = [\"touching\"]\n[[bodies]]\nshape = \"stack\"\ncount = 9\ngap = -0.5\n";
    assert_eq!(check(query), Ok(()));
    let error = Scene::parse("s.toml", &lattice.replace("scene = 1", "scene = 1\nstart = \"anyhow\"")).unwrap_err();
    assert!(error.to_string().starts_with("s.toml:2: unknown variant `anyhow`"), "{error}");
    for example in super::EXAMPLES {
        let scene = super::scene(example);
        check_start(&scene, &Plan::of(&scene).unwrap()).expect("an example begins well");
    }
}
