//! Pictures of few colours: a palette and an index a texel.

use std::collections::BTreeMap;

use color_quant::NeuQuant;

use crate::picture::Picture;

/// Fewest colours that NeuQuant is made for; smaller palettes are merged from these.
const MIN_NETWORK: usize = 64;

/// Share of the pixels that NeuQuant looks at: one in so many, where there are enough.
const SAMPLING: usize = 10;

/// Pixels from which NeuQuant samples.
const SAMPLED_FROM: usize = 1 << 16;

/// Rounds of k-means after it. Each can only lower the squared error; later ones hardly do.
const ROUNDS: usize = 8;

/// A picture by the numbers of its colours.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Indexed {
    /// Red, green and blue; each is used.
    pub palette: Vec<[u8; 3]>,
    /// Positions in the palette, one byte a texel, row by row from the top.
    pub indices: Vec<u8>,
}

/// The picture with a palette of at most `colours`, usually 16 or 256 (brought to 1 to 256).
/// Alpha is left out.
///
/// If the picture has no more colours, they are the palette, in the order of their first texels.
/// Else colours are chosen by NeuQuant (Dekker, "Kohonen neural networks for optimal colour
/// quantization", 1994) and k-means, without dithering. The same picture always gives the same
/// result.
#[must_use]
pub fn indexed(picture: &Picture, colours: usize) -> Indexed {
    let colours = colours.clamp(1, 256);
    exact(picture, colours).unwrap_or_else(|| quantised(picture, colours))
}

/// Indices below 16, `width` of them a row, two a byte: the left one in the high nibble, as in
/// `ImageRaw` of embedded-graphics. Each row starts on a byte of its own, so the low nibble of a
/// single texel is 0. Of larger indices the low four bits are taken.
#[must_use]
pub fn pack4(indices: &[u8], width: u32) -> Vec<u8> {
    indices
        .chunks(width.max(1) as usize)
        .flat_map(|row| row.chunks(2))
        .map(|pair| pair[0] << 4 | pair.get(1).map_or(0, |right| right & 15))
        .collect()
}

/// `None` if there are more colours.
fn exact(picture: &Picture, colours: usize) -> Option<Indexed> {
    let mut numbers = BTreeMap::new();
    let mut palette = Vec::new();
    let mut indices = Vec::with_capacity(picture.pixels().len());
    for &rgb in picture.pixels() {
        let number = *numbers.entry(rgb).or_insert(palette.len());
        if number == palette.len() {
            if number == colours {
                return None;
            }
            palette.push(rgb);
        }
        indices.push(number as u8);
    }
    Some(Indexed { palette, indices })
}

fn quantised(picture: &Picture, colours: usize) -> Indexed {
    let rgba: Vec<u8> = picture
        .pixels()
        .iter()
        .flat_map(|&[r, g, b]| [r, g, b, u8::MAX])
        .collect();
    let sampling = if picture.pixels().len() < SAMPLED_FROM {
        1
    } else {
        SAMPLING
    };
    let network = NeuQuant::new(sampling as i32, colours.max(MIN_NETWORK), &rgba);
    let mut palette = network.color_map_rgb().as_chunks().0.to_vec();
    palette.sort_unstable();
    palette.dedup();

    let mut counts: BTreeMap<[u8; 3], u64> = BTreeMap::new();
    for &rgb in picture.pixels() {
        *counts.entry(rgb).or_default() += 1;
    }
    let mut palette = merged(&palette, colours, &counts);
    fill(&mut palette, colours, &counts);
    for _ in 0..ROUNDS {
        let mut better = means(&clusters(&palette, &counts));
        fill(&mut better, colours, &counts);
        if better == palette {
            break;
        }
        palette = better;
    }
    // What no colour is nearest to any more is not kept.
    palette = clusters(&palette, &counts)
        .iter()
        .zip(palette)
        .filter_map(|(cluster, rgb)| (cluster.count > 0).then_some(rgb))
        .collect();
    let numbers: BTreeMap<_, _> = counts
        .keys()
        .map(|&rgb| (rgb, nearest(&palette, rgb) as u8))
        .collect();
    let indices = picture.pixels().iter().map(|rgb| numbers[rgb]).collect();
    Indexed { palette, indices }
}

/// The pixels for which one colour of the palette stands.
#[derive(Clone, Copy, Default)]
struct Cluster {
    count: u64,
    sum: [u64; 3],
}

impl Cluster {
    fn add(&mut self, other: Self) {
        self.count += other.count;
        for (sum, other) in self.sum.iter_mut().zip(other.sum) {
            *sum += other;
        }
    }

    /// To the nearest; `None` without pixels.
    fn mean(&self) -> Option<[u8; 3]> {
        (self.count > 0).then(|| {
            self.sum
                .map(|sum| ((sum + self.count / 2) / self.count) as u8)
        })
    }

    /// What the squared error grows by when both get one colour (Ward, "Hierarchical grouping to
    /// optimize an objective function", 1963). `None` if either is empty.
    fn cost_of_merging(&self, other: &Self) -> Option<u64> {
        let distance = distance(self.mean()?, other.mean()?);
        Some(u64::from(distance) * self.count * other.count / (self.count + other.count))
    }
}

fn clusters(palette: &[[u8; 3]], counts: &BTreeMap<[u8; 3], u64>) -> Vec<Cluster> {
    let mut clusters = vec![Cluster::default(); palette.len()];
    for (&rgb, &count) in counts {
        let sum = rgb.map(|value| u64::from(value) * count);
        clusters[nearest(palette, rgb)].add(Cluster { count, sum });
    }
    clusters
}

fn means(clusters: &[Cluster]) -> Vec<[u8; 3]> {
    clusters.iter().filter_map(Cluster::mean).collect()
}

/// The means of what the palette's colours stand for, at most so many: the two that cost least
/// become one until that holds.
fn merged(palette: &[[u8; 3]], colours: usize, counts: &BTreeMap<[u8; 3], u64>) -> Vec<[u8; 3]> {
    let mut clusters = clusters(palette, counts);
    clusters.retain(|cluster| cluster.count > 0);
    while clusters.len() > colours {
        let pairs = (0..clusters.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
        let cheapest =
            pairs.min_by_key(|&(i, j)| clusters[i].cost_of_merging(&clusters[j]).unwrap_or(0));
        let Some((i, j)) = cheapest else { break };
        let other = clusters.remove(j);
        clusters[i].add(other);
    }
    means(&clusters)
}

/// Brings the palette to so many colours: the pixels with the largest squared error get their own.
/// NeuQuant and k-means leave some unused where a picture is small or has few colours.
fn fill(palette: &mut Vec<[u8; 3]>, colours: usize, counts: &BTreeMap<[u8; 3], u64>) {
    if palette.len() >= colours {
        return;
    }
    let error = |colour, rgb, count| u64::from(distance(colour, rgb)) * count;
    let mut errors: Vec<_> = counts
        .iter()
        .map(|(&rgb, &count)| {
            (
                error(palette[nearest(palette, rgb)], rgb, count),
                rgb,
                count,
            )
        })
        .collect();
    while palette.len() < colours {
        let Some(&(_, worst, _)) = errors.iter().max() else {
            break;
        };
        palette.push(worst);
        for (least, rgb, count) in &mut errors {
            *least = error(worst, *rgb, *count).min(*least);
        }
    }
}

/// The position of the colour nearest to `rgb`; 0 in an empty palette.
fn nearest(palette: &[[u8; 3]], rgb: [u8; 3]) -> usize {
    let distances = palette.iter().map(|&colour| distance(colour, rgb));
    let nearest = distances.enumerate().min_by_key(|&(_, distance)| distance);
    nearest.map_or(0, |(number, _)| number)
}

/// Squared.
fn distance(a: [u8; 3], b: [u8; 3]) -> u32 {
    (0..3).map(|i| u32::from(a[i].abs_diff(b[i])).pow(2)).sum()
}
