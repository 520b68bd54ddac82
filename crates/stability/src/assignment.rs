//! Assignment of rows to columns at least total cost.
//!
//! Shortest augmenting paths with potentials: Kuhn (1955), Munkres (1957), in
//! the form of Jonker & Volgenant (1987). Cubic in the size; the result does
//! not depend on anything but the costs.

/// For every row of a square cost matrix its column.
pub(crate) fn assign(costs: &[Vec<f64>]) -> Vec<usize> {
    let size = costs.len();
    let mut row_potential = vec![0.0; size + 1];
    let mut column_potential = vec![0.0; size + 1];
    // Column `size` is the place from which each search starts.
    let mut row_of = vec![usize::MAX; size + 1];
    for row in 0..size {
        let (start, mut column) = (size, size);
        row_of[start] = row;
        let mut least = vec![f64::INFINITY; size];
        let mut previous = vec![start; size];
        let mut visited = vec![false; size + 1];
        while row_of[column] != usize::MAX {
            visited[column] = true;
            let current = row_of[column];
            let (mut best, mut step) = (start, f64::INFINITY);
            for next in (0..size).filter(|&next| !visited[next]) {
                let reduced =
                    costs[current][next] - row_potential[current] - column_potential[next];
                if reduced < least[next] {
                    least[next] = reduced;
                    previous[next] = column;
                }
                if least[next] < step {
                    step = least[next];
                    best = next;
                }
            }
            for (place, seen) in visited.iter().enumerate() {
                if *seen {
                    row_potential[row_of[place]] += step;
                    column_potential[place] -= step;
                } else if place < size {
                    least[place] -= step;
                }
            }
            column = best;
        }
        while column != start {
            let before = previous[column];
            row_of[column] = row_of[before];
            column = before;
        }
    }
    let mut columns = vec![0; size];
    for column in 0..size {
        columns[row_of[column]] = column;
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every permutation of five, tried one by one, costs no less.
    #[test]
    fn no_permutation_is_cheaper() {
        let costs: Vec<Vec<f64>> = (0..5)
            .map(|i| {
                (0..5)
                    .map(|j| f64::from((i * 37 + j * 53 + i * j * 11) % 29))
                    .collect()
            })
            .collect();
        let total = |columns: &[usize]| -> f64 {
            columns
                .iter()
                .enumerate()
                .map(|(row, &column)| costs[row][column])
                .sum()
        };
        let found = total(&assign(&costs));
        let mut best = f64::INFINITY;
        let mut order = vec![0, 1, 2, 3, 4];
        permutations(&mut order, 0, &mut |columns| {
            best = best.min(total(columns));
        });
        assert!((found - best).abs() < 1e-12, "{found} != {best}");
    }

    fn permutations(order: &mut Vec<usize>, from: usize, visit: &mut dyn FnMut(&[usize])) {
        if from == order.len() {
            visit(order);
            return;
        }
        for other in from..order.len() {
            order.swap(from, other);
            permutations(order, from + 1, visit);
            order.swap(from, other);
        }
    }
}
