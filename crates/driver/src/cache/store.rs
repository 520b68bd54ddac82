//! A folder of entries.

use super::codec;
use super::entry::{self, Fault};
use super::key::Key;
use crate::failure::Failure;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

const EXTENSION: &str = "gaf";
const TEMPORARY: &str = ".tmp-";
const QUARANTINE: &str = "quarantine";

/// Age at which a temporary file belongs to a process that is gone: writing
/// takes seconds.
const STALE: Duration = Duration::from_hours(1);

/// What may be stored.
pub trait Stored: Serialize + DeserializeOwned {
    /// Whether all values are finite and all sizes fit together.
    fn is_sound(&self) -> bool;
}

/// A store, or none when the folder cannot be used.
#[derive(Debug)]
pub struct Cache {
    folder: Option<PathBuf>,
}

/// What was found under a key.
#[derive(Debug)]
pub struct Loaded<T> {
    /// The value, if a good entry was there.
    pub value: Option<T>,
    /// What the user should know.
    pub warning: Option<String>,
}

/// One file of the store.
#[derive(Debug)]
pub struct Listed<T> {
    /// File.
    pub path: PathBuf,
    /// Key in the file name.
    pub key: Option<Key>,
    /// Bytes.
    pub size: u64,
    /// Last change.
    pub modified: SystemTime,
    /// The value, or why there is none.
    pub content: Result<T, Fault>,
}

impl Cache {
    /// Opens a folder, makes it when it is not there, and removes temporary
    /// files that a process left behind more than an hour ago.
    ///
    /// A folder that cannot be made or written gives a cache that stores
    /// nothing, and a warning: results do not depend on it.
    pub fn open(folder: &Path) -> (Self, Option<String>) {
        match fs::create_dir_all(folder).and_then(|()| probe(folder)) {
            Ok(()) => {
                remove_stale(folder);
                (
                    Self {
                        folder: Some(folder.to_owned()),
                    },
                    None,
                )
            }
            Err(error) if folder.is_dir() => {
                let warning = format!(
                    "the cache {} cannot be written ({error}): entries are read, none is stored",
                    folder.display()
                );
                (
                    Self {
                        folder: Some(folder.to_owned()),
                    },
                    Some(warning),
                )
            }
            Err(error) => {
                let warning = format!(
                    "there is no cache at {} ({error}): nothing is kept for the next run",
                    folder.display()
                );
                (Self { folder: None }, Some(warning))
            }
        }
    }

    /// Opens a folder that is only read; none when it is not there.
    pub fn existing(folder: &Path) -> Self {
        Self {
            folder: folder.is_dir().then(|| folder.to_owned()),
        }
    }

    /// File of a key.
    pub fn path(&self, key: &Key) -> Option<PathBuf> {
        self.folder.as_deref().map(|folder| entry_path(folder, key))
    }

    /// Reads an entry; a bad one is moved away and counts as not there.
    pub fn load<T: Stored>(&self, key: &Key) -> Loaded<T> {
        let Some(folder) = &self.folder else {
            return Loaded {
                value: None,
                warning: None,
            };
        };
        let path = entry_path(folder, key);
        if fs::symlink_metadata(&path).is_err() {
            return Loaded {
                value: None,
                warning: None,
            };
        }
        match read(&path, key) {
            Ok(value) => Loaded {
                value: Some(value),
                warning: None,
            },
            Err(Fault::Older { .. }) => Loaded {
                value: None,
                warning: None,
            },
            Err(fault @ Fault::Newer { .. }) => Loaded {
                value: None,
                warning: Some(bad_entry(&path, &fault)),
            },
            Err(fault) => {
                let moved = quarantine(folder, &path, &fault);
                let done = if moved {
                    "moved to quarantine"
                } else {
                    "could not be moved away"
                };
                let warning = format!("{}; {done}, computed again", bad_entry(&path, &fault));
                Loaded {
                    value: None,
                    warning: Some(warning),
                }
            }
        }
    }

    /// Stores a value; a failure is a warning, because the result is there.
    pub fn publish<T: Stored>(&self, key: &Key, value: &T) -> Option<String> {
        let folder = self.folder.as_deref()?;
        let path = entry_path(folder, key);
        if let Err(fault @ Fault::Newer { .. }) = read::<T>(&path, key) {
            return Some(bad_entry(&path, &fault));
        }
        let Some(payload) = codec::encode(value) else {
            return Some("the result is too large for the cache and was not kept".to_owned());
        };
        let sealed = entry::seal(key, &payload);
        write(folder, &path, &sealed).err().map(|error| {
            let size = sealed.len();
            format!("{} of {size} bytes was not kept: {error}", path.display())
        })
    }

    /// All entries, by file name.
    ///
    /// # Errors
    /// The folder cannot be listed.
    pub fn list<T: Stored>(&self) -> Result<Vec<Listed<T>>, Failure> {
        let Some(folder) = &self.folder else {
            return Ok(Vec::new());
        };
        let failed = |error| Failure::io("list the cache", folder, &error);
        let mut listed = Vec::new();
        for file in fs::read_dir(folder).map_err(failed)? {
            let path = file.map_err(failed)?.path();
            if path
                .extension()
                .is_none_or(|extension| extension != EXTENSION)
            {
                continue;
            }
            listed.push(inspect(path));
        }
        listed.sort_by(|a, b| a.path.cmp(&b.path));
        Ok(listed)
    }

    /// Removes bad entries, what is in quarantine, and entries not changed for
    /// longer than `age`; returns how many files and bytes went.
    ///
    /// # Errors
    /// The folder cannot be listed, or a file cannot be removed.
    pub fn prune<T: Stored>(&self, age: Option<Duration>) -> Result<(usize, u64), Failure> {
        let Some(folder) = &self.folder else {
            return Ok((0, 0));
        };
        let now = SystemTime::now();
        let is_old = |entry: &Listed<T>| {
            let elapsed = now.duration_since(entry.modified).unwrap_or_default();
            age.is_some_and(|age| elapsed >= age)
        };
        let is_newer = |entry: &Listed<T>| matches!(entry.content, Err(Fault::Newer { .. }));
        let (mut files, mut bytes) = (0, 0);
        for entry in self.list::<T>()? {
            if is_newer(&entry) || (entry.content.is_ok() && !is_old(&entry)) {
                continue;
            }
            remove(&entry.path)?;
            (files, bytes) = (files + 1, bytes + entry.size);
        }
        for file in fs::read_dir(folder.join(QUARANTINE))
            .into_iter()
            .flatten()
            .flatten()
        {
            let size = file.metadata().map_or(0, |metadata| metadata.len());
            remove(&file.path())?;
            (files, bytes) = (files + 1, bytes + size);
        }
        remove_stale(folder);
        Ok((files, bytes))
    }
}

fn entry_path(folder: &Path, key: &Key) -> PathBuf {
    folder.join(key.to_hex()).with_extension(EXTENSION)
}

fn bad_entry(path: &Path, fault: &Fault) -> String {
    format!("the cache entry {} was not used: {fault}", path.display())
}

fn read<T: Stored>(path: &Path, key: &Key) -> Result<T, Fault> {
    let unreadable = |error: std::io::Error| Fault::Unreadable(error.to_string());
    let metadata = fs::symlink_metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        return Err(Fault::NotAFile);
    }
    let bytes = fs::read(path).map_err(unreadable)?;
    let payload = entry::open(&bytes, key)?;
    let value: T =
        codec::decode(payload).map_err(|error| Fault::Undecodable(error.to_string()))?;
    if value.is_sound() {
        Ok(value)
    } else {
        Err(Fault::Unsound)
    }
}

fn inspect<T: Stored>(path: PathBuf) -> Listed<T> {
    let metadata = fs::symlink_metadata(&path);
    let key = path
        .file_stem()
        .and_then(|stem| stem.to_str())
        .and_then(Key::from_hex);
    let content = match &key {
        Some(key) => read(&path, key),
        None => Err(Fault::Magic),
    };
    Listed {
        size: metadata.as_ref().map_or(0, fs::Metadata::len),
        modified: metadata
            .and_then(|m| m.modified())
            .unwrap_or(SystemTime::UNIX_EPOCH),
        path,
        key,
        content,
    }
}

/// Whether a file can be made in the folder.
fn probe(folder: &Path) -> std::io::Result<()> {
    tempfile::Builder::new()
        .prefix(TEMPORARY)
        .tempfile_in(folder)
        .map(drop)
}

/// Whole or not at all: temporary file in the same folder, synchronised,
/// made read-only, renamed, folder synchronised.
fn write(folder: &Path, path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = tempfile::Builder::new()
        .prefix(TEMPORARY)
        .tempfile_in(folder)?;
    file.write_all(bytes)?;
    let mut permissions = file.as_file().metadata()?.permissions();
    permissions.set_readonly(true);
    file.as_file().set_permissions(permissions)?;
    file.as_file().sync_all()?;
    file.persist(path)?;
    if let Ok(folder) = fs::File::open(folder) {
        // Some file systems cannot synchronise a folder; the entry is whole
        // all the same.
        let _ = folder.sync_all();
    }
    Ok(())
}

fn quarantine(folder: &Path, path: &Path, fault: &Fault) -> bool {
    let Some(name) = path.file_name() else {
        return false;
    };
    let place = folder.join(QUARANTINE);
    let target = place.join(name);
    if fs::symlink_metadata(&target).is_ok() {
        // An earlier bad entry of the same key; renaming shows if it stays.
        let _ = remove(&target);
    }
    let moved = fs::create_dir_all(&place).and_then(|()| fs::rename(path, &target));
    if moved.is_ok() {
        // The reason is for people; the entry is out of the way without it.
        let _ = fs::write(target.with_extension("txt"), format!("{fault}\n"));
    }
    moved.is_ok()
}

fn remove(path: &Path) -> Result<(), Failure> {
    let is_folder = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_dir());
    let removed = if is_folder {
        fs::remove_dir_all(path)
    } else {
        fs::remove_file(path)
    };
    removed.map_err(|error| Failure::io("remove a cache entry", path, &error))
}

fn remove_stale(folder: &Path) {
    let now = SystemTime::now();
    for file in fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_temporary = file.file_name().to_string_lossy().starts_with(TEMPORARY);
        let age = file
            .metadata()
            .and_then(|m| m.modified())
            .ok()
            .and_then(|t| now.duration_since(t).ok());
        if is_temporary && age.is_some_and(|age| age > STALE) {
            // Another process may have removed it first.
            let _ = fs::remove_file(file.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::KeyBuilder;
    use super::*;
    use serde::Deserialize;

    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    struct Values(Vec<f64>);

    impl Stored for Values {
        fn is_sound(&self) -> bool {
            self.0.iter().all(|value| value.is_finite())
        }
    }

    struct Fixture {
        folder: tempfile::TempDir,
        cache: Cache,
        key: Key,
        value: Values,
    }

    fn stored() -> Fixture {
        let folder = tempfile::tempdir().unwrap();
        let (cache, warning) = Cache::open(folder.path());
        assert_eq!(warning, None);
        let key = KeyBuilder::new("test/1").finish();
        let value = Values((0..400).map(f64::from).collect());
        assert_eq!(cache.publish(&key, &value), None);
        Fixture {
            folder,
            cache,
            key,
            value,
        }
    }

    fn overwrite(path: &Path, bytes: &[u8]) {
        let _ = fs::remove_file(path);
        fs::write(path, bytes).unwrap();
    }

    #[test]
    fn what_was_stored_is_found_again_and_leaves_no_temporary_file() {
        let it = stored();
        assert_eq!(it.cache.load::<Values>(&it.key).value, Some(it.value));
        assert_eq!(fs::read_dir(it.folder.path()).unwrap().count(), 1);
        let path = it.cache.path(&it.key).unwrap();
        assert!(fs::metadata(path).unwrap().permissions().readonly());
    }

    #[test]
    fn a_truncated_entry_is_moved_away_at_every_length() {
        let it = stored();
        let path = it.cache.path(&it.key).unwrap();
        let whole = fs::read(&path).unwrap();
        for length in (0..whole.len()).step_by(7) {
            overwrite(&path, &whole[..length]);
            let loaded = it.cache.load::<Values>(&it.key);
            assert_eq!(loaded.value, None, "{length} bytes were accepted");
            assert!(
                loaded.warning.is_some_and(|text| text.contains("bytes")),
                "{length}"
            );
            assert!(!path.exists());
        }
    }

    #[test]
    fn four_thousand_flipped_bits_are_all_caught() {
        let it = stored();
        let path = it.cache.path(&it.key).unwrap();
        let whole = fs::read(&path).unwrap();
        for flip in 0..4000usize {
            let bit = (flip * 7919) % (whole.len() * 8);
            let mut damaged = whole.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert!(
                entry::open(&damaged, &it.key).is_err(),
                "bit {bit} was accepted"
            );
        }
        let mut damaged = whole;
        damaged[300] ^= 1;
        overwrite(&path, &damaged);
        let warning = it.cache.load::<Values>(&it.key).warning.unwrap();
        assert!(warning.contains("checksum"), "{warning}");
        assert!(
            it.folder
                .path()
                .join(QUARANTINE)
                .join(path.file_name().unwrap())
                .is_file()
        );
    }

    #[test]
    fn junk_emptiness_folders_links_and_foreign_entries_are_misses() {
        let it = stored();
        let path = it.cache.path(&it.key).unwrap();
        let whole = fs::read(&path).unwrap();
        overwrite(&path, &[whole.as_slice(), b"junk"].concat());
        assert_eq!(it.cache.load::<Values>(&it.key).value, None);
        overwrite(&path, b"");
        assert_eq!(it.cache.load::<Values>(&it.key).value, None);
        fs::create_dir(&path).unwrap();
        assert_eq!(it.cache.load::<Values>(&it.key).value, None);
        let other = KeyBuilder::new("test/2").finish();
        overwrite(&it.cache.path(&other).unwrap(), &whole);
        let warning = it.cache.load::<Values>(&other).warning.unwrap();
        assert!(warning.contains("another case"), "{warning}");
        #[cfg(unix)]
        {
            let target = it.folder.path().join("target");
            fs::write(&target, &whole).unwrap();
            std::os::unix::fs::symlink(&target, &path).unwrap();
            assert_eq!(it.cache.load::<Values>(&it.key).value, None);
        }
    }

    #[test]
    fn values_that_are_not_finite_are_never_returned() {
        let it = stored();
        let payload = codec::encode(&Values(vec![f64::NAN])).unwrap();
        overwrite(
            &it.cache.path(&it.key).unwrap(),
            &entry::seal(&it.key, &payload),
        );
        assert_eq!(it.cache.load::<Values>(&it.key).value, None);
    }

    #[test]
    fn a_folder_that_cannot_be_made_turns_the_cache_off_with_one_warning() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, b"").unwrap();
        let (cache, warning) = Cache::open(&file.join("gaf"));
        assert!(warning.is_some());
        let key = KeyBuilder::new("test/1").finish();
        assert_eq!(cache.publish(&key, &Values(vec![1.0])), None);
        assert_eq!(cache.load::<Values>(&key).value, None);
    }

    #[test]
    fn verify_and_prune_see_bad_entries() {
        let it = stored();
        let bad = it.cache.path(&KeyBuilder::new("test/3").finish()).unwrap();
        fs::write(&bad, b"no entry").unwrap();
        let listed = it.cache.list::<Values>().unwrap();
        assert_eq!(
            listed.iter().filter(|entry| entry.content.is_err()).count(),
            1
        );
        assert_eq!(it.cache.prune::<Values>(None).unwrap().0, 1);
        assert!(!bad.exists());
        assert_eq!(it.cache.load::<Values>(&it.key).value, Some(it.value));
    }
}
