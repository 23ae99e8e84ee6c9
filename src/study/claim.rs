//! Claims: a file that says that a process works on a point.
//!
//! The holder changes the file every few seconds. Whoever finds a claim compares two readings of it, a lease apart by
//! its own clock: if they are equal, the holder is dead or cut off. No clock is compared with another machine's, and
//! no lock of the file system is needed, which network file systems may not have.
//!
//! Claims save work and decide nothing. If a holder is suspended for longer than a lease, a point is measured twice,
//! with the same result.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Signs of life in a lease. Several, so that a slow file system does not look like a dead process.
const BEATS: u32 = 6;

/// A claim that this process holds until it is dropped.
#[derive(Debug)]
pub(super) struct Claim {
    path: PathBuf,
    holder: String,
    /// Dropped to stop the beats.
    stop: Option<Sender<()>>,
    beats: Option<JoinHandle<()>>,
}

impl Claim {
    /// The claim with this file; `None` if it is already held.
    pub fn take(path: &Path, lease: Duration) -> io::Result<Option<Self>> {
        let holder = holder();
        match OpenOptions::new().write(true).create_new(true).open(path) {
            Ok(mut file) => file.write_all(content(&holder, 0).as_bytes())?,
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => return Ok(None),
            Err(error) => return Err(error),
        }
        let (stop, stopped) = mpsc::channel();
        let (of, to) = (holder.clone(), path.to_owned());
        let beat = move || {
            for number in 1_u64.. {
                let is_over = stopped.recv_timeout(lease / BEATS) != Err(RecvTimeoutError::Timeout);
                // A beat that cannot be written is made up for by the next one.
                if is_over || !is_held_by(&of, &to) || fs::write(&to, content(&of, number)).is_err() && !to.exists() {
                    break;
                }
            }
        };
        Ok(Some(Self { path: path.to_owned(), holder, stop: Some(stop), beats: Some(thread::spawn(beat)) }))
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(beats) = self.beats.take() {
            let _ = beats.join();
        }
        if is_held_by(&self.holder, &self.path) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// What a claim's file says now; `None` if nobody holds it.
pub(super) fn read(path: &Path) -> io::Result<Option<String>> {
    match fs::read(path) {
        Ok(text) => Ok(Some(String::from_utf8_lossy(&text).into_owned())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

/// Removes a claim whose holder is dead. `found` is what its file has said for a lease: a claim that says something
/// else by now stays.
pub(super) fn remove_dead(path: &Path, found: &str) -> io::Result<()> {
    // A name of our own, so that of two processes only one removes a claim, and sees what it removed.
    let aside = path.with_extension(format!("dead-{}", sha(&holder())));
    match fs::rename(path, &aside) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        renamed => renamed?,
    }
    if read(&aside)?.as_deref() != Some(found) {
        // Someone removed it before us and has claimed the point since: the claim goes back, unless there is another.
        let _ = fs::hard_link(&aside, path);
    }
    fs::remove_file(&aside)
}

fn content(holder: &str, beat: u64) -> String {
    format!("{holder} {beat}\n")
}

fn is_held_by(holder: &str, path: &Path) -> bool {
    read(path).ok().flatten().is_some_and(|text| text.starts_with(&format!("{holder} ")))
}

/// A name for a claim, unlike any other's: the host, the process, the time and a count.
fn holder() -> String {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let nanoseconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos());
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    format!("{} process {} {nanoseconds}.{count}", host.trim(), process::id())
}

fn sha(text: &str) -> String {
    crate::store::sha256(text.as_bytes()).chars().take(16).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEASE: Duration = Duration::from_millis(120);

    #[test]
    fn a_claim_has_one_holder_and_ends_with_it() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let path = room.path().join("point.claim");
        let held = Claim::take(&path, LEASE).expect("written").expect("nobody holds it");
        assert!(Claim::take(&path, LEASE).expect("read").is_none());
        drop(held);
        assert_eq!(fs::read_dir(room.path()).expect("there").count(), 0, "nothing is left");
        assert!(Claim::take(&path, LEASE).expect("written").is_some());
    }

    #[test]
    fn a_held_claim_changes_within_a_lease() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let path = room.path().join("point.claim");
        let _held = Claim::take(&path, LEASE).expect("written").expect("nobody holds it");
        let first = read(&path).expect("read");
        // Far longer than a lease: a test beside others may be late, never early.
        for _ in 0..100 {
            thread::sleep(LEASE / 4);
            if read(&path).expect("read") != first {
                return;
            }
        }
        panic!("no sign of life in 25 leases");
    }

    #[test]
    fn a_dead_claim_is_removed_and_a_live_one_is_not() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let path = room.path().join("point.claim");
        fs::write(&path, "elsewhere process 1 2.3 17\n").expect("written");
        remove_dead(&path, "elsewhere process 1 2.3 16\n").expect("renamed");
        assert_eq!(read(&path).expect("read").as_deref(), Some("elsewhere process 1 2.3 17\n"), "it has beaten since");
        remove_dead(&path, "elsewhere process 1 2.3 17\n").expect("renamed");
        assert_eq!(read(&path).expect("read"), None);
        remove_dead(&path, "elsewhere process 1 2.3 17\n").expect("it is gone");
        assert_eq!(fs::read_dir(room.path()).expect("there").count(), 0, "nothing is left");
    }

    /// Removed by another and claimed by a third: the first holder neither beats on nor removes what is not its own.
    #[test]
    fn a_claim_that_was_taken_over_is_left_to_its_new_holder() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let path = room.path().join("point.claim");
        let held = Claim::take(&path, LEASE).expect("written").expect("nobody holds it");
        fs::remove_file(&path).expect("removed");
        fs::write(&path, "elsewhere process 1 2.3 0\n").expect("written");
        thread::sleep(LEASE);
        drop(held);
        assert_eq!(read(&path).expect("read").as_deref(), Some("elsewhere process 1 2.3 0\n"));
    }
}
