//! A table for a terminal: columns as wide as their widest cell.

/// Aligns rows of cells into lines. The first row is the heading; the columns of `right` are numbers and end at one
/// place, all others begin at one.
pub fn columns(rows: &[Vec<String>], right: &[usize]) -> String {
    let count = rows.iter().map(Vec::len).max().unwrap_or_default();
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or_default()
    };
    let widths: Vec<usize> = (0..count).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
            if right.contains(&column) {
                format!("{cell:>width$}")
            } else {
                format!("{cell:<width$}")
            }
        });
        let line = cells.collect::<Vec<_>>().join("  ");
        format!("{}\n", line.trim_end())
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_end_and_words_begin_at_one_place() {
        let row = |cells: [&str; 3]| cells.map(str::to_owned).to_vec();
        let rows = [row(["shape", "rays", "why"]), row(["box", "12", "ü"]), row(["a", "3456", ""])];
        let text = "shape  rays  why\nbox      12  ü\na      3456\n";
        assert_eq!(columns(&rows, &[1]), text);
        assert_eq!(columns(&[], &[]), "");
    }
}
