//! Several textures in one. Pictures enter; what leaves is one picture and where each of them lies
//! in it, so that a mesh with many small textures needs one table and one pass.
//!
//! Sides and places are powers of two: a rectangle that lies at a multiple of its own size covers
//! whole texels of every mip level down to its own single one, and box averages never mix it with
//! a neighbour.

use multum::texture::MAX_TEXTURE_SIZE;

use crate::error::Error;
use crate::picture::Picture;
use crate::reference::Beyond;

/// A part of a picture, in texels from its top-left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// Column of its first texel.
    pub left: u32,
    /// Row of its first texel.
    pub top: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// A picture made of pictures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Atlas {
    /// All of them. What none covers is black, and transparent if any of them has alpha.
    pub picture: Picture,
    /// Where each of them lies, in the order given.
    pub rectangles: Vec<Rectangle>,
}

/// A picture within more of itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Padded {
    /// The picture and what surrounds it.
    pub picture: Picture,
    /// Where the picture itself lies.
    pub inside: Rectangle,
}

/// Packs pictures into the smallest atlas that this method fills, each at a multiple of its width
/// and its height.
///
/// Box averages of the atlas are those of each picture, level by level, until the shorter side of
/// a picture is one texel. The largest go first, each into the smallest free rectangle, which is
/// halved until it fits (a buddy allocator in two dimensions: Knuth, "The Art of Computer
/// Programming", volume 1, section 2.5); squares leave no holes between them.
///
/// # Errors
///
/// [`Error::Content`] without pictures, or if they do not fit [`MAX_TEXTURE_SIZE`] squared.
pub fn pack(pictures: &[&Picture]) -> Result<Atlas, Error> {
    if pictures.is_empty() {
        return Err(Error::content("atlas", "no pictures", "give at least one"));
    }
    let area = |p: &Picture| u64::from(p.width()) * u64::from(p.height());
    let total: u64 = pictures.iter().map(|p| area(p)).sum();
    // Small atlases before large ones, squares before strips.
    let mut sizes: Vec<(u32, u32)> = (0..=MAX_TEXTURE_SIZE.ilog2())
        .flat_map(|i| (0..=MAX_TEXTURE_SIZE.ilog2()).map(move |j| (1 << i, 1 << j)))
        .filter(|&(width, height)| u64::from(width) * u64::from(height) >= total)
        .collect();
    sizes.sort_by_key(|&(width, height)| (width * height, width.max(height), height));
    let placed = sizes
        .into_iter()
        .find_map(|size| Some((size, place(pictures, size)?)));
    let Some(((width, height), rectangles)) = placed else {
        return Err(Error::content(
            "atlas",
            &format!(
                "{} pictures of {total} texels do not fit {MAX_TEXTURE_SIZE}x{MAX_TEXTURE_SIZE}",
                pictures.len()
            ),
            "make them smaller or use two atlases",
        ));
    };

    let mut pixels = vec![[0; 3]; width as usize * height as usize];
    let has_alpha = pictures.iter().any(|picture| picture.alpha().is_some());
    let mut alpha = has_alpha.then(|| vec![0; pixels.len()]);
    for (picture, rectangle) in pictures.iter().zip(&rectangles) {
        for row in 0..rectangle.height {
            let columns = rectangle.width as usize;
            let from = (row * rectangle.width) as usize;
            let to = ((rectangle.top + row) * width + rectangle.left) as usize;
            let (from, to) = (from..from + columns, to..to + columns);
            pixels[to.clone()].copy_from_slice(&picture.pixels()[from.clone()]);
            if let Some(alpha) = &mut alpha {
                match picture.alpha() {
                    Some(own) => alpha[to].copy_from_slice(&own[from]),
                    None => alpha[to].fill(u8::MAX),
                }
            }
        }
    }
    let picture = Picture::new(width, height, pixels)?;
    let picture = match alpha {
        Some(alpha) => picture.with_alpha(alpha)?,
        None => picture,
    };
    Ok(Atlas {
        picture,
        rectangles,
    })
}

/// Where each lies in an atlas of this size; `None` if they do not fit.
fn place(pictures: &[&Picture], (width, height): (u32, u32)) -> Option<Vec<Rectangle>> {
    let mut order: Vec<usize> = (0..pictures.len()).collect();
    let sides = |i: usize| (pictures[i].width(), pictures[i].height());
    order.sort_by_key(|&i| {
        let (width, height) = sides(i);
        std::cmp::Reverse((width.max(height), width.min(height)))
    });
    // Each has powers of two for sides and lies at multiples of them.
    let mut free = vec![Rectangle {
        left: 0,
        top: 0,
        width,
        height,
    }];
    let mut rectangles = vec![free[0]; pictures.len()];
    for i in order {
        let (width, height) = sides(i);
        let fits = free
            .iter()
            .enumerate()
            .filter(|(_, r)| r.width >= width && r.height >= height);
        let (slot, _) = fits.min_by_key(|(_, r)| (r.width * r.height, r.top, r.left))?;
        let mut rectangle = free.swap_remove(slot);
        while (rectangle.width, rectangle.height) != (width, height) {
            let mut half = rectangle;
            // The relatively longer side first: what is left over stays as square as can be.
            if rectangle.width / width > rectangle.height / height {
                rectangle.width /= 2;
                half.width = rectangle.width;
                half.left += rectangle.width;
            } else {
                rectangle.height /= 2;
                half.height = rectangle.height;
                half.top += rectangle.height;
            }
            free.push(half);
        }
        rectangles[i] = rectangle;
    }
    Some(rectangles)
}

/// The picture in the middle of a larger one, for texture coordinates that lie in an atlas: at
/// least `padding` texels on each side are what lies beyond its edges, so that filters and mip
/// levels find there what wrapping would give them. Each side becomes the next power of two, and
/// all of it is filled in the same way. Without padding it is the picture.
///
/// # Errors
///
/// [`Error::Content`] if a side would exceed [`MAX_TEXTURE_SIZE`].
pub fn padded(picture: &Picture, padding: u32, wrap: Beyond) -> Result<Padded, Error> {
    let side = |side: u32| {
        let needed = u64::from(side) + 2 * u64::from(padding);
        let cell = needed.next_power_of_two();
        if cell > u64::from(MAX_TEXTURE_SIZE) {
            return Err(Error::content(
                "atlas",
                &format!("a side of {side} texels with {padding} more at each end needs {cell}"),
                &format!("pad less or resize the picture: {MAX_TEXTURE_SIZE} is the most"),
            ));
        }
        Ok(cell as u32)
    };
    let (width, height) = (side(picture.width())?, side(picture.height())?);
    let inside = Rectangle {
        left: (width - picture.width()) / 2,
        top: (height - picture.height()) / 2,
        width: picture.width(),
        height: picture.height(),
    };
    // Texel centres: exact, for sizes are powers of two.
    let texel = |at: u32, begin: u32, size: u32| {
        let centre = f64::from(at) - f64::from(begin) + 0.5;
        wrap.texel(centre / f64::from(size), size)
    };
    let sources: Vec<usize> = (0..height)
        .flat_map(|y| {
            let row = texel(y, inside.top, inside.height) * inside.width;
            (0..width).map(move |x| (row + texel(x, inside.left, inside.width)) as usize)
        })
        .collect();
    let pixels = sources.iter().map(|&i| picture.pixels()[i]).collect();
    let mut padded = Picture::new(width, height, pixels)?;
    if let Some(alpha) = picture.alpha() {
        padded = padded.with_alpha(sources.iter().map(|&i| alpha[i]).collect())?;
    }
    Ok(Padded {
        picture: padded,
        inside,
    })
}
