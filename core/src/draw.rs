//! The one file that knows all stages, and joins them.

use heapless::Vec;

use crate::arith::{SHIFTS_OPERANDS, keep_in_place};
use crate::clip::{ClipPolygon, ClipVertex, ClipVolume, MOST_CORNERS};
use crate::corner::{Corner, Rows};
use crate::depth::{Depth, DepthRow};
use crate::error::Error;
use crate::perspective::{Run, RunSink, SpanSink, Strategy};
use crate::project::ScreenVertex;
use crate::setup::{Cull, TriangleSetup};
use crate::shade::{Shader, ShaderRow};
use crate::sink::PixelSink;
use crate::span::{Area, Span};
use crate::uv::{Curve, Eight, Uv};
use crate::viewport::{SUBPIXEL_BITS, SUBPIXELS};

/// A choice of strategy, sampler, depth test and culling: what a scene is drawn with.
///
/// The choices are types. Those that hold no state take no memory, and code that is not chosen is
/// not in the image.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pipeline<P, S, D> {
    /// How texture coordinates are corrected for perspective.
    pub strategy: P,
    /// Where colours come from: a [`Sampler`](crate::sample::Sampler) or another [`Shader`].
    pub sampler: S,
    /// Which pixels are hidden.
    pub depth: D,
    /// Which triangles are left out.
    pub cull: Cull,
}

impl<P: Strategy, S: Shader, D: Depth> Pipeline<P, S, D> {
    /// Draws triangles over clip-space vertices, in order, into the part of the frame that `sink`
    /// has.
    ///
    /// `volume` holds the near distance and the size of the whole frame. `vertices` are
    /// [`ClipVertex`]es, or take more memory and less time as
    /// [`ProjectedVertex`](crate::corner::ProjectedVertex)es.
    ///
    /// # Errors
    ///
    /// [`Error::IndexOutOfRange`] at the first triangle that names a vertex beyond `vertices`;
    /// those before it are drawn. Not possible with the tables of one mesh.
    pub fn draw<K, V: Corner>(
        &mut self,
        sink: &mut K,
        volume: &ClipVolume,
        vertices: &[V],
        triangles: &[[u16; 3]],
    ) -> Result<(), Error>
    where
        K: PixelSink,
        S::Texel: Into<K::Pixel>,
    {
        let mut polygon = ScreenPolygon::new();
        let rows = Rows::new(sink.area(), volume.viewport());
        for (triangle, indices) in triangles.iter().enumerate() {
            if !on_screen(&mut polygon, volume, rows.as_ref(), vertices, indices) {
                return Err(Error::IndexOutOfRange { triangle });
            }
            // Triangles around the first corner.
            while let Some(corners) = polygon.first_chunk() {
                self.draw_triangle(sink, corners);
                let next = polygon.pop();
                if let (Some(next), Some([_, b, c])) = (next, polygon.first_chunk_mut()) {
                    (*b, *c) = (*c, next);
                }
            }
        }
        Ok(())
    }

    /// Draws one triangle given after projection.
    ///
    /// Nothing is drawn if it has no area, is culled, misses the sink's area, or spans
    /// [`MAX_UV_SPAN`](crate::geometry::MAX_UV_SPAN) repeats of the texture or more.
    pub fn draw_triangle<K>(&mut self, sink: &mut K, vertices: &[ScreenVertex; 3])
    where
        K: PixelSink,
        S::Texel: Into<K::Pixel>,
    {
        let area = sink.area();
        if misses(vertices, area) {
            return;
        }
        let Some(triangle) = TriangleSetup::new(vertices, self.cull) else {
            return;
        };
        // Borrowed and not taken out: planes are large, and to move them takes longer than to draw
        // a few pixels.
        let planes = self.strategy.planes(&triangle);
        let Some(planes) = &planes else {
            return;
        };
        let depth_plane = self.depth.plane(&triangle);
        let shading = self.sampler.triangle(&triangle);
        // What a level of detail needs is more than registers hold, and would be copied.
        if const { size_of::<S::Triangle>() > size_of::<[usize; 4]>() } {
            keep_in_place(&shading);
        }
        let drawing = Drawing {
            sink,
            depth: &mut self.depth,
            sampler: &self.sampler,
            depth_plane: &depth_plane,
            shading: &shading,
        };
        self.strategy.all_runs(planes, &triangle, area, drawing);
    }
}

/// The corners of a convex polygon on the screen: the first three in their order, and then from the last
/// to the fourth.
type ScreenPolygon = Vec<ScreenVertex, MOST_CORNERS>;

/// What is left of a triangle in clip space, on the screen: nothing if a corner is not in range or all
/// lie beside the rows. `false` if it names a vertex that is not there.
// A function of its own: it is the same for all pipelines.
#[inline(never)]
fn on_screen<V: Corner>(
    polygon: &mut ScreenPolygon,
    volume: &ClipVolume,
    rows: Option<&Rows>,
    vertices: &[V],
    indices: &[u16; 3],
) -> bool {
    polygon.clear();
    let corners = indices.map(|i| vertices.get(usize::from(i)));
    let [Some(a), Some(b), Some(c)] = corners else {
        return false;
    };
    if let Some(rows) = rows
        && a.beside(volume, rows) & b.beside(volume, rows) & c.beside(volume, rows) != 0
    {
        return true;
    }
    for corner in [a, b, c] {
        let Some(corner) = corner.screen(volume) else {
            clip(polygon, volume, [a, b, c].map(V::clip));
            return true;
        };
        // There is room for all, here and below.
        _ = polygon.push(corner);
    }
    true
}

/// The same for a triangle that may have to be cut.
#[inline(never)]
fn clip(polygon: &mut ScreenPolygon, volume: &ClipVolume, corners: [&ClipVertex; 3]) {
    polygon.clear();
    let mut clipped = ClipPolygon::new();
    volume.clip_into(&mut clipped, corners);
    let (first, rest) = clipped.split_at_checked(3).unwrap_or_default();
    for corner in first.iter().chain(rest.iter().rev()) {
        let Some(corner) = ScreenVertex::project(corner, volume.viewport()) else {
            polygon.clear();
            return;
        };
        _ = polygon.push(corner);
    }
}

/// Draws the spans of one triangle.
struct Drawing<'d, K, D: Depth, S: Shader> {
    sink: &'d mut K,
    depth: &'d mut D,
    depth_plane: &'d D::Plane,
    sampler: &'d S,
    shading: &'d S::Triangle,
}

impl<K: PixelSink, D: Depth, S: Shader<Texel: Into<K::Pixel>>> SpanSink for Drawing<'_, K, D, S> {
    type Runs<'s>
        = Filler<'s, K::Pixel, D::Row<'s>, S::Row<'s>>
    where
        Self: 's;

    #[inline]
    fn span(&mut self, span: Span) -> Option<Self::Runs<'_>> {
        Some(Filler {
            pixels: self.sink.span(span)?,
            depths: self.depth.row(self.depth_plane, span)?,
            shader: self.sampler.row(self.shading, span),
        })
    }
}

/// Fills the pixels of one span.
struct Filler<'p, P, D, S> {
    pixels: &'p mut [P],
    depths: D,
    shader: S,
}

impl<P, D: DepthRow, S: ShaderRow<Texel: Into<P>>> RunSink for Filler<'_, P, D, S> {
    #[inline]
    fn run(&mut self, run: Run) {
        self.short_run(run);
    }

    // Always: beside runs that are short after all a call is much.
    #[inline(always)]
    fn long_run(&mut self, run: Run) {
        let end = run.offset.wrapping_add(run.len);
        if let Some(pixels) = self.pixels.get_mut(run.offset..end) {
            self.depths.fill_long(run, pixels, &mut self.shader);
        }
    }

    // Always: beside so few pixels a call is much.
    #[inline(always)]
    fn short_run(&mut self, run: Run) {
        let end = run.offset.wrapping_add(run.len);
        if let Some(pixels) = self.pixels.get_mut(run.offset..end) {
            self.depths.fill(run, pixels, &mut self.shader);
        }
    }

    #[inline]
    fn pieces<const N: usize>(
        &mut self,
        offset: usize,
        count: usize,
        next: impl FnMut() -> (Uv, Uv),
    ) {
        let end = offset.wrapping_add(count.wrapping_mul(N));
        if let Some(pixels) = self.pixels.get_mut(offset..end) {
            let (pieces, _) = pixels.as_chunks_mut::<N>();
            self.depths.pieces(offset, pieces, next, &mut self.shader);
        }
    }

    #[inline]
    fn curve(&mut self, offset: usize, len: usize, curve: Curve) {
        let end = offset.wrapping_add(len);
        if let Some(pixels) = self.pixels.get_mut(offset..end) {
            let shader = &mut self.shader;
            self.depths.curve(offset, curve, pixels, shader);
        }
    }

    #[inline]
    fn curves<const N: usize>(
        &mut self,
        offset: usize,
        count: usize,
        mut next: impl FnMut() -> Curve,
    ) {
        let end = offset.wrapping_add(count.wrapping_mul(N));
        if let Some(pixels) = self.pixels.get_mut(offset..end) {
            let mut offset = offset;
            for pixels in pixels.as_chunks_mut::<N>().0 {
                self.depths.curve(offset, next(), pixels, &mut self.shader);
                offset = offset.wrapping_add(N);
            }
        }
    }

    #[inline]
    fn eights(
        &mut self,
        offset: usize,
        len: usize,
        eights: impl IntoIterator<Item = Eight>,
    ) -> bool {
        if !self.shader.takes_eights() {
            return false;
        }
        let end = offset.wrapping_add(len);
        if let Some(pixels) = self.pixels.get_mut(offset..end) {
            let (pixels, _) = pixels.as_chunks_mut();
            let shader = &mut self.shader;
            self.depths.eights(offset, pixels, eights, shader);
        }
        true
    }

    #[inline]
    fn points<T, const N: usize>(
        &mut self,
        offset: usize,
        count: usize,
        state: T,
        here: impl Fn(&T) -> Uv,
        next: impl FnMut(&mut T),
    ) {
        let end = offset.wrapping_add(count);
        if let Some(pixels) = self.pixels.get_mut(offset..end) {
            let shader = &mut self.shader;
            self.depths
                .points::<_, _, _, N>(offset, pixels, state, here, next, shader);
        }
    }
}

/// Whether no pixel centre of `area` can lie in the triangle: its box lies beside it.
#[inline]
fn misses(vertices: &[ScreenVertex; 3], area: Area) -> bool {
    // Where a shift is no instruction the area's sides are shifted up, which are constants most often, and
    // elsewhere the corners down.
    let (area, down) = if const { SHIFTS_OPERANDS } {
        let up = |pixels: i32| pixels.saturating_mul(SUBPIXELS);
        let Area { width, top, bottom } = area;
        let (width, top, bottom) = (up(width), up(top), up(bottom));
        (Area { width, top, bottom }, 0)
    } else {
        (area, SUBPIXEL_BITS)
    };
    vertices.iter().all(|v| v.y().to_bits() >> down < area.top)
        || vertices
            .iter()
            .all(|v| v.y().to_bits() >> down >= area.bottom)
        || vertices.iter().all(|v| v.x().to_bits() < 0)
        || vertices
            .iter()
            .all(|v| v.x().to_bits() >> down >= area.width)
}
