//! Level of detail. Derivatives of the texture coordinates enter; the mip levels to read leave. In
//! between is lambda, the binary logarithm of the level-0 texels that one pixel spans.

use super::Sample;

/// How the derivatives become rho, the level-0 texels that one pixel spans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rule {
    /// The largest of |du/dx| W, |dv/dx| H, |du/dy| W and |dv/dy| H: at most half a level below
    /// [`Self::Euclidean`], and within what OpenGL and Vulkan permit.
    #[default]
    LongestAxis,
    /// The longer of (du/dx W, dv/dx H) and (du/dy W, dv/dy H): OpenGL 4.6 core, section 8.14.
    Euclidean,
}

impl Rule {
    /// rho of a texture of this size in texels; 0 or more, and 0 where all derivatives are.
    #[must_use]
    pub fn rho(self, sample: &Sample, size: [f64; 2]) -> f64 {
        match self {
            Self::LongestAxis => [sample.dx, sample.dy]
                .iter()
                .flat_map(|d| [d[0] * size[0], d[1] * size[1]])
                .fold(0.0, |rho, axis| axis.abs().max(rho)),
            Self::Euclidean => sample.footprint(size),
        }
    }
}

/// How a positive lambda becomes mip levels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// The finest level, whatever lambda is: no mip mapping.
    Base,
    /// One level, ceil(lambda + 1/2) - 1: OpenGL's `NEAREST_MIPMAP_*`. At a tie the finer.
    #[default]
    Nearest,
    /// One level, ceil(lambda) + 1: its texels are never smaller than a pixel, so that nearest
    /// sampling of it skips none.
    Safest,
    /// Level floor(lambda) and the next, blended by the fraction: OpenGL's `LINEAR_MIPMAP_*`.
    Linear,
}

/// What a [`Lod`] chose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Chosen {
    /// lambda <= 0: this level, with the magnification filter.
    Magnified(u32),
    /// This level, with the minification filter.
    One(u32),
    /// Two different levels, with the minification filter.
    Two {
        /// The level with more texels.
        finer: u32,
        /// The next level.
        coarser: u32,
        /// The part of the coarser level: 0 or more, less than 1.
        weight: f64,
    },
}

/// Level of detail: lambda' = clamp(log2(rho) + bias, min, max), then a choice of levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lod {
    /// Makes rho from the derivatives.
    pub rule: Rule,
    /// Makes levels from lambda.
    pub choice: Choice,
    /// Added to lambda, in levels; positive values blur.
    pub bias: f64,
    /// Smallest lambda, after the bias. Positive values keep the magnification filter away.
    pub min: f64,
    /// Largest lambda, after the bias. It wins over a larger `min`.
    pub max: f64,
    /// Finest level in memory: no finer one is read. Past the last level, it is the last level.
    pub resident: u32,
}

impl Default for Lod {
    /// The longest axis, the nearest level, and limits that a texture up to 4096 texels wide does
    /// not meet.
    fn default() -> Self {
        Self {
            rule: Rule::default(),
            choice: Choice::default(),
            bias: 0.0,
            min: 0.0,
            max: 12.0,
            resident: 0,
        }
    }
}

impl Lod {
    /// lambda' of a texture whose level 0 has this size in texels.
    #[must_use]
    pub fn lambda(&self, sample: &Sample, size: [f64; 2]) -> f64 {
        self.lambda_of(self.rule.rho(sample, size))
    }

    /// lambda' of a rho in level-0 texels. No texels at all, or not a number, give `min`.
    #[must_use]
    pub fn lambda_of(&self, rho: f64) -> f64 {
        // Unlike `clamp`, these two take NaN for absent, and limits in the wrong order.
        (rho.log2() + self.bias).max(self.min).min(self.max)
    }

    /// The levels that a lambda' selects of `count` levels; `count` 0 counts as 1.
    #[must_use]
    pub fn levels(&self, lambda: f64, count: usize) -> Chosen {
        let last = u32::try_from(count.saturating_sub(1)).unwrap_or(u32::MAX);
        let finest = self.resident.min(last);
        if lambda.is_nan() || lambda <= 0.0 {
            return Chosen::Magnified(finest);
        }
        // The cast saturates, so that any positive lambda is within the levels afterwards.
        let limited = |level: f64| (level as u32).clamp(finest, last);
        match self.choice {
            Choice::Base => Chosen::One(finest),
            Choice::Nearest => Chosen::One(limited((lambda + 0.5).ceil() - 1.0)),
            Choice::Safest => Chosen::One(limited(lambda.ceil() + 1.0)),
            Choice::Linear => {
                let floor = lambda.floor();
                let (finer, coarser) = (limited(floor), limited(floor + 1.0));
                if finer == coarser {
                    return Chosen::One(finer);
                }
                Chosen::Two {
                    finer,
                    coarser,
                    weight: lambda - floor,
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(dx: [f64; 2], dy: [f64; 2]) -> Sample {
        Sample {
            uv: [0.0; 2],
            w: 1.0,
            dx,
            dy,
        }
    }

    fn lod(choice: Choice) -> Lod {
        Lod {
            choice,
            ..Lod::default()
        }
    }

    #[test]
    fn rho_is_the_longest_axis_or_the_longest_step() {
        // Right: (3, 4) texels of a 256 x 64 texture; down: (-4.5, 0).
        let s = sample([3.0 / 256.0, 4.0 / 64.0], [-4.5 / 256.0, 0.0]);
        assert_eq!(Rule::LongestAxis.rho(&s, [256.0, 64.0]), 4.5);
        assert_eq!(Rule::Euclidean.rho(&s, [256.0, 64.0]), 5.0);
        // Each of the four derivatives counts, with the size of its own axis.
        for (i, wanted) in [8.0, 2.0, 8.0, 2.0].into_iter().enumerate() {
            let mut d = [0.0; 4];
            d[i] = -1.0 / 32.0;
            let s = sample([d[0], d[1]], [d[2], d[3]]);
            for rule in [Rule::LongestAxis, Rule::Euclidean] {
                assert_eq!(rule.rho(&s, [256.0, 64.0]), wanted, "{rule:?} {i}");
            }
        }
    }

    #[test]
    fn the_rules_are_at_most_half_a_level_apart() {
        // A rotation by 45 degrees is the worst: the length is sqrt(2) times the axis.
        let s = sample([0.5, 0.5], [-0.5, 0.5]);
        let of = |rule| Lod {
            rule,
            ..Lod::default()
        };
        let axis = of(Rule::LongestAxis).lambda(&s, [16.0; 2]);
        let length = of(Rule::Euclidean).lambda(&s, [16.0; 2]);
        assert_eq!(axis, 3.0);
        assert!((length - 3.5).abs() < 1e-12, "{length}");
    }

    #[test]
    fn lambda_is_biased_before_it_is_limited() {
        let limits = Lod {
            bias: 0.75,
            min: 1.0,
            max: 5.0,
            ..Lod::default()
        };
        assert_eq!(limits.lambda_of(8.0), 3.75);
        assert_eq!(limits.lambda_of(1.0), 1.0);
        assert_eq!(limits.lambda_of(1.25), 1.25f64.log2() + 0.75);
        assert_eq!(limits.lambda_of(32.0), 5.0);
        assert_eq!(Lod::default().lambda_of(0.25), 0.0);
        assert_eq!(Lod::default().lambda_of(1e9), 12.0);
    }

    #[test]
    fn a_lambda_without_a_value_is_the_lower_limit() {
        let lod = Lod {
            min: 0.5,
            ..Lod::default()
        };
        for d in [0.0, f64::NAN] {
            assert_eq!(lod.lambda(&sample([d; 2], [d; 2]), [64.0; 2]), 0.5);
        }
        let endless = sample([f64::INFINITY, 0.0], [0.0; 2]);
        assert_eq!(lod.lambda(&endless, [64.0; 2]), 12.0);
        let crossed = Lod {
            min: 3.0,
            max: 2.0,
            ..Lod::default()
        };
        assert_eq!(crossed.lambda_of(1.0), 2.0);
    }

    #[test]
    fn the_nearest_level_switches_just_above_the_half() {
        let nearest = |lambda| lod(Choice::Nearest).levels(lambda, 7);
        let eps = 1e-9;
        for (lambda, level) in [
            (eps, 0),
            (0.5, 0),
            (0.5 + eps, 1),
            (1.5, 1),
            (1.5 + eps, 2),
            (5.5 + eps, 6),
            (6.0, 6),
            (11.0, 6),
            (f64::INFINITY, 6),
        ] {
            assert_eq!(nearest(lambda), Chosen::One(level), "{lambda}");
        }
    }

    #[test]
    fn the_safest_level_has_texels_of_a_pixel_or_more() {
        let safest = |lambda| lod(Choice::Safest).levels(lambda, 7);
        for (lambda, level) in [
            (1e-9, 2),
            (1.0, 2),
            (1.0 + 1e-9, 3),
            (4.0, 5),
            (4.5, 6),
            (6.0, 6),
        ] {
            assert_eq!(safest(lambda), Chosen::One(level), "{lambda}");
        }
    }

    #[test]
    fn two_levels_are_blended_by_the_fraction_until_the_last() {
        let two = |finer, coarser, weight| Chosen::Two {
            finer,
            coarser,
            weight,
        };
        let linear = |lambda| lod(Choice::Linear).levels(lambda, 7);
        assert_eq!(linear(0.25), two(0, 1, 0.25));
        assert_eq!(linear(1.0), two(1, 2, 0.0));
        assert_eq!(linear(2.75), two(2, 3, 0.75));
        assert_eq!(linear(5.5), two(5, 6, 0.5));
        assert_eq!(linear(6.0), Chosen::One(6));
        assert_eq!(linear(9.5), Chosen::One(6));
    }

    #[test]
    fn lambda_zero_and_below_magnifies_whatever_the_choice() {
        for choice in [
            Choice::Base,
            Choice::Nearest,
            Choice::Safest,
            Choice::Linear,
        ] {
            for lambda in [0.0, -0.0, -3.0, f64::NEG_INFINITY, f64::NAN] {
                let chosen = lod(choice).levels(lambda, 7);
                assert_eq!(chosen, Chosen::Magnified(0), "{choice:?} {lambda}");
            }
        }
        assert_eq!(lod(Choice::Base).levels(5.0, 7), Chosen::One(0));
    }

    #[test]
    fn no_level_finer_than_the_resident_one_is_read() {
        let from_2 = |choice| Lod {
            choice,
            resident: 2,
            ..Lod::default()
        };
        for choice in [
            Choice::Base,
            Choice::Nearest,
            Choice::Safest,
            Choice::Linear,
        ] {
            let lod = from_2(choice);
            assert_eq!(lod.levels(0.0, 7), Chosen::Magnified(2), "{choice:?}");
            assert_eq!(lod.levels(0.75, 7), Chosen::One(2), "{choice:?}");
            // Where that level is missing too, the last one serves.
            assert_eq!(lod.levels(0.75, 2), Chosen::One(1), "{choice:?}");
            assert_eq!(lod.levels(-1.0, 0), Chosen::Magnified(0), "{choice:?}");
        }
        assert_eq!(from_2(Choice::Linear).levels(1.5, 7), Chosen::One(2));
        assert_eq!(
            from_2(Choice::Linear).levels(2.5, 7),
            Chosen::Two {
                finer: 2,
                coarser: 3,
                weight: 0.5
            }
        );
    }
}
