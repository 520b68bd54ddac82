//! Figure 1: the fit of one entry of Q at constant g and at constant k.

use faer::{Mat, c64};
use fladder::plot::{Graph, Mark, Series, Sheet, sheet};
use fladder_stability::{GafPoint, GafTable, PiecewiseQuadratic};

use super::PaperError;
use super::work::{LAPLACE, Work};

/// Lines of constant g that are drawn: places in [`LAPLACE`].
const LINES: [usize; 5] = [0, 1, 3, 5, 6];
/// Lines of constant k that are drawn: places in the case's k, in parts of its length.
const COLUMNS: [f64; 4] = [0.2, 0.45, 0.7, 0.9];
const STEPS: usize = 240;

/// An entry with its samples and its fit.
struct Entry<'a> {
    work: &'a Work,
    place: usize,
    k: Vec<f64>,
    fit: PiecewiseQuadratic,
    largest: f64,
}

/// The figure; the name of the entry's mode; the largest error between samples as a part
/// of the largest value.
pub(super) fn figure(work: &Work) -> Result<(String, String, f64), PaperError> {
    let entry = Entry::new(work)?;
    let mut worst = 0.0_f64;
    let mut graphs = Vec::new();
    let drawn_k: Vec<f64> = COLUMNS
        .iter()
        .map(|part| entry.k[(part * (entry.k.len() - 1) as f64) as usize])
        .collect();
    let by_k = LINES.map(|line| {
        let g = LAPLACE[line];
        Line {
            fixed: g,
            is_over_k: true,
            ends: [entry.k[usize::from(g < 0.0)], entry.k[entry.k.len() - 1]],
            samples: entry.k.clone(),
        }
    });
    let by_g = drawn_k.iter().map(|k| Line {
        fixed: *k,
        is_over_k: false,
        ends: [LAPLACE[0], LAPLACE[LAPLACE.len() - 1]],
        samples: LAPLACE.to_vec(),
    });
    let names = [
        by_k.iter()
            .map(|line| format!("g = {}", line.fixed).replace('-', "−"))
            .collect::<Vec<_>>(),
        drawn_k.iter().map(|k| format!("k = {k:.3}")).collect(),
    ]
    .concat();
    let by_k = by_k.to_vec();
    let by_g: Vec<Line> = by_g.collect();
    for (lines, first, what, label) in [
        (&by_k, 0, "at constant g", "reduced frequency  k  [–]"),
        (
            &by_g,
            by_k.len(),
            "at constant k",
            "reduced damping  g  [–]",
        ),
    ] {
        for (part, is_real) in [("real", true), ("imaginary", false)] {
            let mut series = Vec::new();
            for (number, line) in lines.iter().enumerate() {
                let (drawn, error) = entry.series(line, first + number, is_real)?;
                worst = worst.max(error);
                series.extend(drawn);
            }
            graphs.push(Graph {
                title: format!("{part} part {what}"),
                labels: [label.to_owned(), "Q".to_owned()],
                ranges: [None, None],
                series,
            });
        }
    }
    let name = work.study.modes()[entry.place].name.clone();
    let picture = sheet(&Sheet {
        title: &format!("Figure 1: fit of Q({name}, {name})"),
        note: "Lines: piecewise quadratic of the samples at seven g. Markers: samples. Dots: true values \
               between them.",
        groups: &names,
        marks: &[(Mark::Dots, "true value")],
        graphs: &graphs,
    });
    Ok((picture, name, worst))
}

/// A line of constant g or k.
#[derive(Clone, Debug)]
struct Line {
    fixed: f64,
    is_over_k: bool,
    ends: [f64; 2],
    samples: Vec<f64>,
}

impl Line {
    fn p(&self, along: f64) -> c64 {
        if self.is_over_k {
            c64::new(self.fixed, along)
        } else {
            c64::new(along, self.fixed)
        }
    }

    fn has_value(&self, along: f64) -> bool {
        let p = self.p(along);
        p.im > 0.0 || p.re >= 0.0
    }
}

impl<'a> Entry<'a> {
    /// The diagonal entry of the elastic mode of the lowest frequency, of the first mode
    /// where there is none.
    fn new(work: &'a Work) -> Result<Self, PaperError> {
        let study = &work.study;
        let lowest = study
            .structure()
            .and_then(|model| model.elastic.first())
            .map(|mode| mode.name.as_str());
        let place = study
            .modes()
            .iter()
            .position(|mode| Some(mode.name.as_str()) == lowest)
            .unwrap_or_default();
        let k = study.file().case.gaf.k.clone();
        let mut points = Vec::new();
        let mut largest = 0.0_f64;
        for g in LAPLACE {
            for k in &k {
                if *k > 0.0 || g >= 0.0 {
                    let q = study.transfer().q(c64::new(g, *k))?[(place, place)];
                    largest = largest.max(q.norm());
                    points.push(GafPoint {
                        g,
                        k: *k,
                        q: Mat::from_fn(1, 1, |_, _| q),
                    });
                }
            }
        }
        let name = study.modes()[place].name.clone();
        let semichord = study.transfer().semichord();
        let table = GafTable::new(semichord, 0.0, vec![name], points, vec![None])?;
        let fit = PiecewiseQuadratic::laplace(&table)?;
        Ok(Self {
            work,
            place,
            k,
            fit,
            largest,
        })
    }

    fn truth(&self, p: c64) -> Result<c64, PaperError> {
        let q = self.work.study.transfer().q(p)?;
        Ok(q[(self.place, self.place)])
    }

    fn fitted(&self, p: c64) -> c64 {
        self.fit.cell_at(p).q(p)[(0, 0)]
    }

    /// Fit, samples and true values between them along a line; the largest error there.
    fn series(
        &self,
        line: &Line,
        group: usize,
        is_real: bool,
    ) -> Result<([Series; 3], f64), PaperError> {
        let part = |q: c64| if is_real { q.re } else { q.im };
        let [from, to] = line.ends;
        let along = |i: usize| from + (to - from) * i as f64 / STEPS as f64;
        let fit = (0..=STEPS)
            .map(along)
            .filter(|x| line.has_value(*x))
            .map(|x| [x, part(self.fitted(line.p(x)))])
            .collect();
        let (mut samples, mut between) = (Vec::new(), Vec::new());
        let mut worst = 0.0_f64;
        let there = line.samples.iter().copied().filter(|x| line.has_value(*x));
        let there: Vec<f64> = there.collect();
        for x in &there {
            samples.push([*x, part(self.truth(line.p(*x))?)]);
        }
        for pair in there.windows(2) {
            let x = f64::midpoint(pair[0], pair[1]);
            let truth = self.truth(line.p(x))?;
            worst = worst.max((self.fitted(line.p(x)) - truth).norm() / self.largest);
            between.push([x, part(truth)]);
        }
        let drawn = |mark, points| Series {
            mark,
            group: (mark != Mark::Dots).then_some(group),
            points,
        };
        Ok((
            [
                drawn(Mark::Line, fit),
                drawn(Mark::Points, samples),
                drawn(Mark::Dots, between),
            ],
            worst,
        ))
    }
}
