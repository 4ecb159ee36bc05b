//! Wall time of every case with Criterion: `cargo bench -p benches --bench time [-- FILTER]`.
//!
//! Times are nanoseconds per pixel, or per triangle for `mesh`. A frame is drawn as a whole; clearing
//! it before is not timed.

use std::time::{Duration, Instant};

use benches::case::{Case, all};
use benches::scene::{MESH, Unit};
use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};

/// Wall time, displayed per unit of a frame.
struct Per(Unit);

impl Measurement for Per {
    type Intermediate = Instant;
    type Value = Duration;

    fn start(&self) -> Instant {
        WallTime.start()
    }

    fn end(&self, start: Instant) -> Duration {
        WallTime.end(start)
    }

    fn add(&self, a: &Duration, b: &Duration) -> Duration {
        WallTime.add(a, b)
    }

    fn zero(&self) -> Duration {
        WallTime.zero()
    }

    fn to_f64(&self, value: &Duration) -> f64 {
        WallTime.to_f64(value)
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        self
    }
}

impl ValueFormatter for Per {
    fn scale_values(&self, _: f64, nanoseconds: &mut [f64]) -> &'static str {
        for value in nanoseconds {
            *value /= self.0.count as f64;
        }
        if self.0 == Unit::PIXEL {
            "ns/pixel"
        } else {
            "ns/triangle"
        }
    }

    fn scale_throughputs(&self, _: f64, _: &Throughput, _: &mut [f64]) -> &'static str {
        ""
    }

    fn scale_for_machines(&self, _: &mut [f64]) -> &'static str {
        "ns"
    }
}

fn settings(unit: Unit) -> Criterion<Per> {
    Criterion::default()
        .with_measurement(Per(unit))
        .sample_size(20)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(800))
        .without_plots()
}

fn quads(criterion: &mut Criterion<Per>) {
    time(criterion, |case| case.scene != MESH);
}

fn mesh(criterion: &mut Criterion<Per>) {
    time(criterion, |case| case.scene == MESH);
}

fn time(criterion: &mut Criterion<Per>, chosen: fn(&Case) -> bool) {
    for case in all().into_iter().filter(chosen) {
        let mut group = criterion.benchmark_group(case.scene);
        group.sampling_mode(SamplingMode::Flat);
        group.bench_function(case.drawer.to_string(), |bencher| {
            let mut drawing = case.drawing().expect("all cases can be drawn");
            bencher.iter_custom(|frames| {
                let mut sum = Duration::ZERO;
                for _ in 0..frames {
                    drawing.clear();
                    let start = Instant::now();
                    drawing.draw();
                    sum += start.elapsed();
                }
                sum
            });
        });
        group.finish();
    }
}

criterion_group! {
    name = per_pixel;
    config = settings(Unit::PIXEL);
    targets = quads
}
criterion_group! {
    name = per_triangle;
    config = settings(Unit::TRIANGLE);
    targets = mesh
}
criterion_main!(per_pixel, per_triangle);
