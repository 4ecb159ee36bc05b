//! Triangles in clip space, of vertices that are projected for each of them or once a frame, into a whole
//! frame or into bands of it: always the pixels that come from clipping and projecting them one by one.

use multum::clip::{ClipVertex, ClipVolume, fan};
use multum::corner::{Corner, ProjectedVertex, Rows};
use multum::depth::NoDepth;
use multum::draw::Pipeline;
use multum::error::Error;
use multum::fixed::types::I16F16;
use multum::perspective::PerPixel;
use multum::project::ScreenVertex;
use multum::sample::Nearest;
use multum::setup::Cull;
use multum::shade::Shader;
use multum::sink::Band;
use multum::span::Area;
use multum::texture::{Repeat, Texture};
use multum::viewport::Viewport;
use rand::Rng as _;
use tests::random::{Rng, seeded};

/// Columns and rows of the frames.
const SIZES: [[u32; 2]; 5] = [[97, 83], [320, 240], [3, 200], [1024, 7], [1, 1]];

/// What no triangle writes.
const BLANK: u16 = 0xffff;

fn vertex([x, y, w, u, v]: [f64; 5]) -> ClipVertex {
    let [x, y, w, u, v] = [x, y, w, u, v].map(I16F16::saturating_from_num);
    ClipVertex { x, y, w, u, v }
}

/// On the screen, around it, beyond the guard band, behind the eye; some with texture coordinates that no
/// mesh has.
fn any_vertex(random: &mut Rng) -> ClipVertex {
    let w = match random.random_range(0..8) {
        0 => random.random_range(-20.0..1.0),
        1 => [0.0, 1.0, 1.0 / 65_536.0][random.random_range(0..3)],
        2 => random.random_range(-5e-4..1e-3),
        _ => random.random_range(0.0f64..6.0).exp(),
    };
    let far = [0.3, 1.0, 1.1, 4.0, 60.0][random.random_range(0..5)];
    let [x, y] = [0; 2].map(|_| random.random_range(-far..=far) * w.abs());
    let repeats = if random.random_range(0..60) == 0 {
        200.0
    } else {
        3.0
    };
    let [u, v] = [0; 2].map(|_| random.random_range(-repeats..repeats));
    vertex([x, y, w, u, v])
}

fn volume([width, height]: [u32; 2], near: I16F16) -> ClipVolume {
    ClipVolume::new(Viewport::new(width, height).expect("a size"), near)
}

/// Draws a frame in bands of so many rows; `draw` draws to one of them.
fn frame(
    [width, height]: [u32; 2],
    rows: u32,
    mut draw: impl FnMut(&mut Band<'_, u16>),
) -> Vec<u16> {
    let mut frame = vec![BLANK; width as usize * height as usize];
    let bands = frame.chunks_mut(width as usize * rows as usize);
    for (pixels, top) in bands.zip((0..height).step_by(rows as usize)) {
        let rows = rows.min(height - top);
        let band = Band::new(pixels, width, rows, width as usize, top);
        draw(&mut band.expect("a band"));
    }
    frame
}

/// Draws a mesh by the pipeline, whatever knows its vertices.
fn in_bands<V: Corner>(
    pipeline: &mut Pipeline<PerPixel, impl Shader<Texel = u16>, NoDepth>,
    size: [u32; 2],
    rows: u32,
    volume: &ClipVolume,
    vertices: &[V],
    triangles: &[[u16; 3]],
) -> Vec<u16> {
    frame(size, rows, |band| {
        let result = pipeline.draw(band, volume, vertices, triangles);
        assert_eq!(result, Ok(()));
    })
}

#[test]
fn all_ways_to_draw_a_mesh_are_the_same() {
    let texels: Vec<u16> = (0..64 * 64).collect();
    let texture = Texture::new(&texels, 64, 64).expect("a texture");
    let mut pipeline = Pipeline {
        strategy: PerPixel,
        sampler: Nearest::<_, Repeat>::new(texture),
        depth: NoDepth,
        cull: Cull::Off,
    };
    let mut random = seeded(910);
    let (mut drawn, mut cut, mut whole, mut known) = (0, 0, 0, 0);
    for case in 0..1_500 {
        let size = SIZES[case % SIZES.len()];
        // So near that cuts are rounded to many pixels, too.
        let near = [I16F16::ONE, I16F16::DELTA][case / SIZES.len() % 2];
        let volume = volume(size, near);
        let vertices: Vec<_> = (0..12).map(|_| any_vertex(&mut random)).collect();
        let triangles: Vec<[u16; 3]> = (0..15)
            .map(|_| [0; 3].map(|_| random.random_range(0..12)))
            .collect();
        let expected = frame(size, size[1], |band| {
            for triangle in &triangles {
                let corners = triangle.map(|i| vertices[usize::from(i)]);
                let polygon = volume.clip(&corners);
                let corners: Option<Vec<_>> = polygon
                    .iter()
                    .map(|corner| ScreenVertex::project(corner, volume.viewport()))
                    .collect();
                cut += u32::from(polygon.len() > 3);
                whole += u32::from(polygon.len() == 3);
                for [a, b, c] in fan(&polygon)
                    .map(|part| part.map(|v| ScreenVertex::project(v, volume.viewport())))
                {
                    // A triangle with a corner that is out of range is not drawn, nor parts of it.
                    if let (Some(_), Some(a), Some(b), Some(c)) = (&corners, a, b, c) {
                        pipeline.draw_triangle(band, &[a, b, c]);
                    }
                }
            }
        });
        drawn += usize::from(expected.iter().any(|&pixel| pixel != BLANK));
        let projected: Vec<_> = vertices
            .iter()
            .map(|v| ProjectedVertex::new(*v, &volume))
            .collect();
        known += projected
            .iter()
            .filter(|v| v.screen(&volume).is_some())
            .count();
        for rows in [1, 3, 16, 240, size[1]] {
            let found = [
                in_bands(&mut pipeline, size, rows, &volume, &vertices, &triangles),
                in_bands(&mut pipeline, size, rows, &volume, &projected, &triangles),
            ];
            assert!(
                found.iter().all(|found| *found == expected),
                "{size:?} {rows}: {vertices:?} {triangles:?}"
            );
        }
    }
    assert!(
        drawn > 900 && cut > 2_000 && whole > 2_000 && known > 5_000,
        "{drawn} {cut} {whole} {known}"
    );
}

/// An index beyond the table is an error, whether the triangle would be drawn or not.
#[test]
fn an_index_out_of_range_is_found_in_every_band() {
    let size = [97, 83];
    let volume = volume(size, I16F16::ONE);
    let vertices =
        [[-0.5, 0.9], [0.5, 0.9], [0.0, 0.8]].map(|[x, y]| vertex([x, y, 1.0, 0.0, 0.0]));
    let projected = vertices.map(|v| ProjectedVertex::new(v, &volume));
    let texture = Texture::new(&[0u16; 4], 2, 2).expect("a texture");
    let mut pipeline = Pipeline {
        strategy: PerPixel,
        sampler: Nearest::<_, Repeat>::new(texture),
        depth: NoDepth,
        cull: Cull::Off,
    };
    _ = frame(size, 7, |band| {
        let triangles = [[0, 1, 2], [0, 1, 3]];
        let wrong = Err(Error::IndexOutOfRange { triangle: 1 });
        assert_eq!(pipeline.draw(band, &volume, &vertices, &triangles), wrong);
        assert_eq!(pipeline.draw(band, &volume, &projected, &triangles), wrong);
    });
}

/// A vertex is said to lie beside a band only if it does, and always if it does by more than a pixel.
#[test]
fn corners_beside_a_band_are_told() {
    let mut random = seeded(911);
    let (mut near, mut beside) = (0, 0);
    for case in 0..300_000 {
        let size @ [width, height] = SIZES[case % SIZES.len()];
        let volume = volume(size, I16F16::ONE);
        let mut corner = any_vertex(&mut random);
        let top = random.random_range(0..height as i32);
        let area = Area {
            width: width as i32,
            top,
            bottom: random.random_range(top + 1..=height as i32),
        };
        let Some(rows) = Rows::new(area, volume.viewport()) else {
            assert_eq!((area.top, area.bottom), (0, height as i32));
            continue;
        };
        if case % 2 == 0 && corner.w > 0 {
            // Within two pixels of an edge of the band.
            let row =
                f64::from([area.top, area.bottom][case / 2 % 2]) + random.random_range(-2.0..2.0);
            let y = (1.0 - 2.0 * row / f64::from(height)) * corner.w.to_num::<f64>();
            corner.y = I16F16::saturating_from_num(y);
        }
        let found = corner.beside(&volume, &rows);
        let Some(place) = corner.screen(&volume) else {
            continue;
        };
        let y = place.y().to_num::<f64>();
        let [top, bottom] = [area.top, area.bottom].map(f64::from);
        let is_beside = |margin: f64| {
            if y < top - margin {
                Rows::ABOVE
            } else if y > bottom + margin {
                Rows::BELOW
            } else {
                0
            }
        };
        let exactly = is_beside(0.0);
        assert_eq!(
            ProjectedVertex::new(corner, &volume).beside(&volume, &rows),
            exactly
        );
        if found != exactly {
            assert_eq!(
                (found, is_beside(1.0)),
                (0, 0),
                "{corner:?} {area:?} {height}: {y}"
            );
            near += 1;
        }
        beside += u32::from(found != 0);
    }
    assert!(near > 1_000 && beside > 20_000, "{near} {beside}");
}

/// What cannot be projected lies nowhere.
#[test]
fn an_empty_vertex_is_not_drawn() {
    let volume = volume([97, 83], I16F16::ONE);
    let area = Area {
        width: 97,
        top: 20,
        bottom: 30,
    };
    let rows = Rows::new(area, volume.viewport()).expect("a band");
    for corner in [ProjectedVertex::NONE, ProjectedVertex::default()] {
        assert_eq!(corner.screen(&volume), None);
        assert_eq!(corner.beside(&volume, &rows), 0);
        assert_eq!(corner.clip(), &ClipVertex::NONE);
    }
    assert_eq!(ClipVertex::NONE, ClipVertex::default());
    assert_eq!(ClipVertex::NONE.beside(&volume, &rows), 0);
}
