//! Our costs and the peers' side by side.

use std::fmt::Write as _;

use comfy_table::presets::ASCII_MARKDOWN;
use comfy_table::{CellAlignment, Table};

use crate::case::{Case, Drawer};
use crate::ours::Way;
use crate::peers::Peer;
use crate::scene::Unit;

/// What one frame of a case costs.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// The case.
    pub case: Case,
    /// Instructions.
    pub instructions: u64,
    /// Nanoseconds.
    pub time: f64,
}

/// A row for each of our cases; peers in the row of their counterpart, as how many times our
/// instructions and our time they take. What differs in their work is said below.
#[must_use]
pub fn side_by_side(costs: &[Cost]) -> String {
    let mut table = Table::new();
    table.load_preset(ASCII_MARKDOWN);
    let mut header: Vec<String> = ["scene", "strategy", "filter", "depth"]
        .map(str::to_owned)
        .to_vec();
    header.extend(["instr / pixel", "ns / pixel"].map(|unit| format!("ours: {unit}")));
    header.extend(Peer::ALL.map(|peer| format!("{peer}: instr, time")));
    table.set_header(header);
    for cost in costs {
        if let Drawer::Ours(way) = cost.case.drawer {
            table.add_row(row(cost, way, costs));
        }
    }
    for column in table.column_iter_mut().skip(4) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let mut text = format!("{table}\n");
    _ = writeln!(text, "\n{}: per triangle.", crate::scene::MESH);
    for peer in Peer::ALL {
        let way = peer.counterpart();
        _ = writeln!(text, "{peer}, beside {way}: {}.", peer.differences());
    }
    text
}

fn row(cost: &Cost, way: Way, costs: &[Cost]) -> Vec<String> {
    let scene = cost.case.scene;
    let unit = Unit::of(scene).count as f64;
    let mut row = vec![scene.to_owned()];
    row.extend(way.names().map(str::to_owned));
    let instructions = cost.instructions as f64;
    // Hundreds and thousands a triangle need no fractions.
    let digits = if unit < 10_000.0 { 0 } else { 2 };
    row.push(format!("{:.digits$}", instructions / unit));
    row.push(format!("{:.digits$}", cost.time / unit));
    row.extend(Peer::ALL.map(|peer| {
        let case = Case {
            scene,
            drawer: Drawer::Peer(peer),
        };
        match costs.iter().find(|other| other.case == case) {
            Some(other) if peer.counterpart() == way => format!(
                "{:.2} {:.2}",
                other.instructions as f64 / instructions,
                other.time / cost.time
            ),
            _ => String::new(),
        }
    }));
    row
}

#[cfg(test)]
mod tests {
    use super::{Cost, side_by_side};
    use crate::case::{Case, Drawer};
    use crate::ours::Way;
    use crate::peers::Peer;

    #[test]
    fn a_peer_stands_in_the_row_of_its_counterpart_as_a_ratio() {
        let cost = |drawer, instructions, time| Cost {
            case: Case {
                scene: "wall",
                drawer,
            },
            instructions,
            time,
        };
        let text = side_by_side(&[
            cost(Drawer::Ours(Way::Affine), 76_800, 76_800.0),
            cost(Drawer::Ours(Way::Exact), 153_600, 38_400.0),
            cost(Drawer::Peer(Peer::Euc), 307_200, 115_200.0),
        ]);
        let cells = |text: &str| -> Vec<String> {
            let line = text.lines().find(|line| line.contains("exact"));
            let cells = line.unwrap_or_default().split('|').map(str::trim);
            cells.map(str::to_owned).collect()
        };
        let expected = [
            "",
            "wall",
            "exact",
            "nearest",
            "none",
            "2.00",
            "0.50",
            "",
            "2.00 3.00",
            "",
            "",
        ];
        assert_eq!(cells(&text), expected);
    }
}
