//! The core against the pixels of an independent OpenGL implementation.

use std::path::Path;

use host_sim::conformance::run;

#[test]
fn every_case_agrees() {
    let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance");
    let families = run(&dir, 1.0 / 64.0).expect("the data set is part of the repository");
    let count = |name: &str| {
        let family = families.iter().find(|f| f.name == name);
        family.map(|f| (f.cases, f.mismatches))
    };
    assert_eq!(count("coverage tri64"), Some((1000, 0)));
    assert_eq!(count("coverage tri320"), Some((60, 0)));
    assert_eq!(count("coverage mesh"), Some((40, 0)));
    assert_eq!(count("texel"), Some((80, 0)));
    assert_eq!(count("filter"), Some((60, 0)));
    assert_eq!(count("lod"), Some((12, 0)));

    // A comparison of nothing would agree as well: 810,874 pixels are covered, of which about one
    // in sixteen lies within 1/64 texel of an edge on either axis.
    let texel = families
        .iter()
        .find(|f| f.name == "texel")
        .expect("counted above");
    assert!(texel.pixels > 80 * 160 * 120 * 9 / 10, "{texel:?}");
    assert_eq!(texel.exempt, 1);
    // Of these the data set's own README counts the pixels that must agree; the rest of a tile is
    // background, of which an edge case can only have more.
    for (name, agree, others) in [
        ("filter", 390_339, 8_877 + 4_411),
        ("lod", 39_830, 28_210 + 2_010),
    ] {
        let family = families.iter().find(|f| f.name == name).expect(name);
        assert_eq!(
            family.quads + family.ties + family.exempt,
            others,
            "{family:?}"
        );
        let background = family.cases * 96 * 96 - agree - others;
        assert_eq!(family.pixels, agree + background, "{family:?}");
    }
}

#[test]
fn a_wider_tie_band_only_moves_pixels_into_it() {
    let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance");
    let at = |tolerance| {
        let families = run(&dir, tolerance).expect("the data set is part of the repository");
        families
            .into_iter()
            .find(|f| f.name == "texel")
            .expect("a texel family")
    };
    let (narrow, wide) = (at(1.0 / 1024.0), at(1.0 / 16.0));
    assert!(narrow.ties < wide.ties);
    assert_eq!(narrow.ties + narrow.pixels, wide.ties + wide.pixels);
}
