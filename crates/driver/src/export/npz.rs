//! NumPy archives (`.npz`): a zip file with one `.npy` array an entry.
//!
//! Arrays are in C order. Nothing in the files depends on the time of writing.

use crate::failure::Failure;
use crate::gaf_json::Document;
use faer::Mat;
use fladder_stability::StateMatrix;
use npyz::npz::file_name_from_array_name;
use npyz::{AutoSerialize, DType, WriteOptions, WriterBuilder};
use std::io::Cursor;
use std::path::Path;
use zip::write::FileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Stored, not packed, with the date of the format's beginning.
fn plain() -> FileOptions {
    FileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default())
}

struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    fn new() -> Self {
        Self(ZipWriter::new(Cursor::new(Vec::new())))
    }

    fn begin(&mut self, name: &str) -> std::io::Result<()> {
        let file = file_name_from_array_name(name);
        self.0.start_file(file, plain()).map_err(Into::into)
    }

    fn add<T: AutoSerialize>(
        &mut self,
        name: &str,
        shape: &[u64],
        values: impl IntoIterator<Item = T>,
    ) -> std::io::Result<()> {
        self.begin(name)?;
        let mut array = WriteOptions::new()
            .default_dtype()
            .shape(shape)
            .writer(&mut self.0)
            .begin_nd()?;
        array.extend(values)?;
        array.finish()
    }

    /// Texts as byte strings of one length.
    fn add_texts(&mut self, name: &str, texts: &[String]) -> std::io::Result<()> {
        let length = texts.iter().map(String::len).max().unwrap_or(0).max(1);
        let text_type = format!("|S{length}")
            .parse()
            .map_err(std::io::Error::other)?;
        self.begin(name)?;
        let mut array = WriteOptions::<[u8]>::new()
            .dtype(DType::Plain(text_type))
            .shape(&[texts.len() as u64])
            .writer(&mut self.0)
            .begin_nd()?;
        for text in texts {
            array.push(text.as_bytes())?;
        }
        array.finish()
    }

    fn finish(mut self) -> std::io::Result<Vec<u8>> {
        Ok(self.0.finish()?.into_inner())
    }
}

/// Forces: `g`, `k` and `q[point, row, column]`, `modes`, `frames`, `steady` (NaN where
/// unknown), `semichord`, `mach`, `alpha_deg`, `beta_deg`.
pub(crate) fn forces(path: &Path, document: &Document) -> Result<Vec<u8>, Failure> {
    let written = || -> std::io::Result<Vec<u8>> {
        let (points, modes) = (document.points.len() as u64, document.modes.len() as u64);
        let mut archive = Archive::new();
        archive.add("g", &[points], document.points.iter().map(|point| point.g))?;
        archive.add("k", &[points], document.points.iter().map(|point| point.k))?;
        let entries = document
            .points
            .iter()
            .flat_map(|point| point.q.iter().flatten())
            .map(|[re, im]| faer::c64::new(*re, *im));
        archive.add("q", &[points, modes, modes], entries)?;
        archive.add_texts("modes", &document.modes)?;
        let frames: Vec<String> = document
            .frames
            .iter()
            .map(|frame| frame.word().to_owned())
            .collect();
        archive.add_texts("frames", &frames)?;
        let steady = document
            .steady
            .iter()
            .map(|force| force.unwrap_or(f64::NAN));
        archive.add("steady", &[document.steady.len() as u64], steady)?;
        for (name, value) in [
            ("semichord", document.semichord),
            ("mach", document.mach),
            ("alpha_deg", document.alpha_deg),
            ("beta_deg", document.beta_deg),
        ] {
            archive.add(name, &[], [value])?;
        }
        archive.finish()
    };
    written().map_err(|error| Failure::io("write the archive", path, &error))
}

/// A matrix of a model.
type Part = fn(&StateMatrix) -> &Mat<f64>;

/// State-space models: `speed`, `density`, `modes`, `states`, `lags`, `poles`, and
/// `A[speed, row, column]` with $\dot x = Ax$, $x = (\xi, (b/U)\dot\xi, w_1, …)$; `M`, `C` and
/// `K` of the structure alike.
pub(crate) fn states(
    path: &Path,
    modes: &[String],
    states: &[StateMatrix],
) -> Result<Vec<u8>, Failure> {
    let written = || -> std::io::Result<Vec<u8>> {
        let count = states.len() as u64;
        let size = states.first().map_or(0, |state| state.matrix.nrows());
        let mut archive = Archive::new();
        archive.add("speed", &[count], states.iter().map(|state| state.airspeed))?;
        archive.add(
            "density",
            &[count],
            states.iter().map(|state| state.density),
        )?;
        archive.add_texts("modes", modes)?;
        let lags = size / modes.len().max(1);
        archive.add("lags", &[], [lags.saturating_sub(2) as i64])?;
        if let Some(first) = states.first() {
            archive.add_texts("states", &first.states(modes))?;
            let poles = first.poles.iter().copied();
            archive.add("poles", &[first.poles.len() as u64], poles)?;
        }
        let kinds: [(&str, Part); 4] = [
            ("A", |state| &state.matrix),
            ("M", |state| &state.mass),
            ("C", |state| &state.damping),
            ("K", |state| &state.stiffness),
        ];
        for (name, matrix) in kinds {
            let order = states.first().map_or(0, |state| matrix(state).nrows()) as u64;
            let entries = states.iter().flat_map(|state| rows(matrix(state)));
            archive.add(name, &[count, order, order], entries)?;
        }
        archive.finish()
    };
    written().map_err(|error| Failure::io("write the archive", path, &error))
}

fn rows(matrix: &Mat<f64>) -> impl Iterator<Item = f64> + '_ {
    (0..matrix.nrows()).flat_map(move |i| (0..matrix.ncols()).map(move |j| matrix[(i, j)]))
}
