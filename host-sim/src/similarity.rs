//! How like one picture is to another.

/// Peak signal to noise ratio over the three channels, 8 bits each, in dB; `None` where all pixels
/// are equal.
#[must_use]
pub fn psnr(a: &[[u8; 3]], b: &[[u8; 3]]) -> Option<f64> {
    let square: f64 = a
        .iter()
        .flatten()
        .zip(b.iter().flatten())
        .map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2))
        .sum();
    let mean = square / (3 * a.len().max(1)) as f64;
    (mean > 0.0).then(|| 10.0 * (255.0 * 255.0 / mean).log10())
}

/// Side of the window in which structures are compared, in pixels.
const WINDOW: usize = 11;
/// Standard deviation of its weights, in pixels.
const SIGMA: f64 = 1.5;
/// What keeps the quotients of means and of variances finite, on a scale of 0 to 255.
const STABILISERS: [f64; 2] = [
    (0.01 * 255.0) * (0.01 * 255.0),
    (0.03 * 255.0) * (0.03 * 255.0),
];

/// Structural similarity of the luma of two pictures of `width` columns, -1 to 1, equal ones 1: the
/// mean over all windows of 11x11 pixels that lie within the picture, with Gaussian weights (Wang,
/// Bovik, Sheikh and Simoncelli, "Image quality assessment: from error visibility to structural
/// similarity", IEEE Transactions on Image Processing 13(4), 2004). Luma is that of ITU-R BT.601.
///
/// `None` where the pictures have different sizes, or no window has room in them.
#[must_use]
pub fn ssim(a: &[[u8; 3]], b: &[[u8; 3]], width: usize) -> Option<f64> {
    let rows = a.len().checked_div(width)?;
    if a.len() != b.len() || width < WINDOW || rows < WINDOW {
        return None;
    }
    let (a, b) = (luma(a), luma(b));
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).collect::<Vec<_>>();
    let means = [&a, &b, &product(&a, &a), &product(&b, &b), &product(&a, &b)]
        .map(|values| weighted(values, width));
    let [mean_a, mean_b, square_a, square_b, both] = &means;
    let [for_means, for_variances] = STABILISERS;
    let windows = mean_a.len();
    let sum: f64 = (0..windows)
        .map(|i| {
            let (x, y) = (mean_a[i], mean_b[i]);
            let variances = square_a[i] - x * x + square_b[i] - y * y;
            let covariance = both[i] - x * y;
            (2.0 * x * y + for_means) * (2.0 * covariance + for_variances)
                / ((x * x + y * y + for_means) * (variances + for_variances))
        })
        .sum();
    Some(sum / windows as f64)
}

fn luma(pixels: &[[u8; 3]]) -> Vec<f64> {
    let of =
        |[r, g, b]: &[u8; 3]| 0.299 * f64::from(*r) + 0.587 * f64::from(*g) + 0.114 * f64::from(*b);
    pixels.iter().map(of).collect()
}

/// Weighted means over all windows, row by row.
fn weighted(values: &[f64], width: usize) -> Vec<f64> {
    let weights = gaussian();
    let along_rows: Vec<Vec<f64>> = values
        .chunks_exact(width)
        .map(|row| {
            row.windows(WINDOW)
                .map(|window| dot(window, &weights))
                .collect()
        })
        .collect();
    along_rows
        .windows(WINDOW)
        .flat_map(|rows| {
            let columns = rows[0].len();
            (0..columns).map(move |x| {
                rows.iter()
                    .zip(&weights)
                    .map(|(row, weight)| row[x] * weight)
                    .sum()
            })
        })
        .collect()
}

fn dot(a: &[f64], b: &[f64; WINDOW]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Weights along one axis; their sum is 1.
fn gaussian() -> [f64; WINDOW] {
    let weights: [f64; WINDOW] = std::array::from_fn(|i| {
        let distance = i as f64 - (WINDOW / 2) as f64;
        (-distance * distance / (2.0 * SIGMA * SIGMA)).exp()
    });
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

#[cfg(test)]
mod tests {
    use super::{psnr, ssim};

    const WIDTH: usize = 24;

    fn picture(value: impl Fn(usize, usize) -> u8) -> Vec<[u8; 3]> {
        (0..WIDTH * 16)
            .map(|i| [value(i % WIDTH, i / WIDTH); 3])
            .collect()
    }

    #[test]
    fn equal_pictures_are_alike() {
        let a = picture(|x, y| (x * 7 + y * 13) as u8);
        assert_eq!(psnr(&a, &a), None);
        let alike = ssim(&a, &a, WIDTH).unwrap_or_default();
        assert!((alike - 1.0).abs() < 1e-12, "{alike}");
    }

    #[test]
    fn flat_pictures_are_compared_by_their_means() {
        let (x, y) = (100.0, 150.0);
        let alike = ssim(&picture(|_, _| 100), &picture(|_, _| 150), WIDTH).unwrap_or_default();
        let means = (2.0 * x * y + 6.5025) / (x * x + y * y + 6.5025);
        assert!((alike - means).abs() < 1e-9, "{alike}, not {means}");
    }

    #[test]
    fn the_negative_of_a_pattern_is_its_opposite() {
        let checker = |x: usize, y: usize| if (x + y).is_multiple_of(2) { 28 } else { 228 };
        let alike = ssim(
            &picture(checker),
            &picture(|x, y| 255 - checker(x, y) + 1),
            WIDTH,
        );
        assert!(
            alike.is_some_and(|s| (-1.0..-0.9).contains(&s)),
            "{alike:?}"
        );
    }

    #[test]
    fn known_pictures_have_the_value_of_another_implementation() {
        let a = picture(|x, y| ((x * 37 + y * 101) % 256) as u8);
        let b = picture(|x, y| ((x * 37 + y * 101 + (x * y) % 23) % 256) as u8);
        let alike = ssim(&a, &b, WIDTH).unwrap_or_default();
        assert!((alike - KNOWN).abs() < 1e-9, "{alike}");
    }

    /// scikit-image 0.26: `structural_similarity(a, b, gaussian_weights=True, sigma=1.5,
    /// use_sample_covariance=False, data_range=255)`, over its windows that lie within the picture.
    const KNOWN: f64 = 0.743_060_630_029_904_4;

    #[test]
    fn what_cannot_be_compared_has_no_similarity() {
        let a = picture(|_, _| 0);
        assert_eq!(ssim(&a, &a[1..], WIDTH), None);
        assert_eq!(ssim(&a[..WIDTH * 10], &a[..WIDTH * 10], WIDTH), None);
        assert_eq!(ssim(&a, &a, 0), None);
    }
}
