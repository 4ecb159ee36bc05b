//! What is measured draws the scenes: ours and the peers'.

use benches::case::{Case, Drawer, all};
use benches::drawing::EMPTY;
use benches::error::Error;
use benches::ours::Way;
use benches::peers::Peer;
use benches::scene::{MESH, NAMES, PIXELS};
use benches::texture;
use multum::embedded_graphics::pixelcolor::Rgb565;

fn frame(case: Case) -> Result<Vec<Rgb565>, Error> {
    let mut drawing = case.drawing()?;
    drawing.clear();
    drawing.draw();
    Ok(drawing.pixels().to_vec())
}

/// The share of pixels that a peer gives the colour that we do with perspective at every pixel.
fn agreement(scene: &'static str, peer: Peer) -> Result<f64, Error> {
    let frame = |drawer| frame(Case { scene, drawer });
    let (theirs, ours) = (frame(Drawer::Peer(peer))?, frame(Drawer::Ours(Way::Exact))?);
    let same = theirs.iter().zip(&ours).filter(|(a, b)| a == b).count();
    Ok(same as f64 / PIXELS as f64)
}

#[test]
fn every_case_covers_every_pixel() -> Result<(), Error> {
    assert!(!texture::pyramid().contains(&EMPTY), "a texel looks empty");
    for case in all() {
        let empty = frame(case)?.iter().filter(|&&p| p == EMPTY).count();
        assert_eq!(empty, 0, "{case}");
    }
    Ok(())
}

#[test]
fn clearing_leaves_nothing() -> Result<(), Error> {
    for case in all() {
        let mut drawing = case.drawing()?;
        let once = frame(case)?;
        drawing.draw();
        drawing.clear();
        assert!(drawing.pixels().iter().all(|&p| p == EMPTY), "{case}");
        // Nor in a depth buffer: what is drawn again is all there.
        drawing.draw();
        assert!(drawing.pixels() == once, "{case}");
    }
    Ok(())
}

/// A texel's border is crossed early or late where single precision rounds: retrofire adds up 320
/// steps, which can be off by 320 2^-24 of 16 repeats, 0.08 texel, and each of u and v then takes
/// another texel at as many pixels in the worst place. Another mapping would hardly agree anywhere:
/// an affine one does in 2 % of `receding`.
#[test]
fn peers_with_perspective_at_every_pixel_draw_our_picture() -> Result<(), Error> {
    for scene in NAMES {
        for peer in [Peer::Euc, Peer::Retrofire] {
            let share = agreement(scene, peer)?;
            assert!(share > 0.95, "{scene} {peer}: {share}");
        }
    }
    Ok(())
}

/// Where w is constant along an edge, or nearly so as on `mesh`, edges are right. Texels of `mesh` are as
/// large as pixels and its corners move by up to half a pixel, so that a part takes the one beside.
#[test]
fn embedded_3dgfx_draws_our_picture_where_edges_need_no_perspective() -> Result<(), Error> {
    let share = agreement("wall", Peer::Embedded3dgfx)?;
    assert!(share > 0.95, "wall: {share}");
    let share = agreement(MESH, Peer::Embedded3dgfx)?;
    assert!(share > 0.5, "mesh: {share}");
    Ok(())
}

/// What the table says of it: it interpolates u, v and w down the edges as if they were affine.
#[test]
fn embedded_3dgfx_bends_what_needs_perspective_down_the_edges() -> Result<(), Error> {
    for scene in ["floor", "receding", "oblique", "tilted"] {
        let share = agreement(scene, Peer::Embedded3dgfx)?;
        assert!(share < 0.5, "{scene}: {share}");
    }
    Ok(())
}
