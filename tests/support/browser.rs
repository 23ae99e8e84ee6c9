//! Opens pages in headless Chromium: their final document, messages on the console, and network requests.
#![allow(dead_code)] // each test uses only some of these

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Supported programs, in order of preference.
const PROGRAMS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];
/// Flags that disable the network and persistent state.
const FLAGS: [&str; 15] = [
    "--headless",
    "--no-sandbox",
    // WebGL in software, because test machines have no graphics card.
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-default-apps",
    "--disable-extensions",
    "--disable-dev-shm-usage",
    "--mute-audio",
    // Name resolution fails for every host, but requests are still logged.
    "--host-resolver-rules=MAP * ~NOTFOUND",
];
/// No page takes longer than this.
const PATIENCE: Duration = Duration::from_secs(90);

/// The page after Chromium has loaded it.
#[derive(Debug)]
pub struct Opened {
    /// The document after all scripts have run.
    pub dom: String,
    /// The page's errors and warnings on the console, including violations of its policy.
    pub console: Vec<String>,
    /// Addresses requested from a network; `data:` addresses and the page itself are not included.
    pub fetched: BTreeSet<String>,
}

/// Finds the program.
///
/// # Panics
/// Panics if it is not installed: ./scripts/setup --test installs it.
fn chromium() -> &'static str {
    let runs = |program: &&&str| {
        Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
    };
    PROGRAMS.iter().find(runs).expect("chromium is missing: ./scripts/setup --test installs it")
}

fn run(arguments: &[String]) -> Output {
    let profile = tempfile::tempdir().expect("a temporary folder");
    let out = tempfile::NamedTempFile::new().expect("a temporary file");
    let err = tempfile::NamedTempFile::new().expect("a temporary file");
    let mut child = Command::new(chromium())
        .args(FLAGS)
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(out.reopen().expect("a file"))
        .stderr(err.reopen().expect("a file"))
        .spawn()
        .expect("chromium starts");
    let begun = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("a child") {
            break status;
        }
        if begun.elapsed() > PATIENCE {
            child.kill().expect("a child");
            child.wait().expect("a child");
            panic!("chromium did not come to an end: {}", fs::read_to_string(err.path()).unwrap_or_default());
        }
        std::thread::sleep(Duration::from_millis(50));
    };
    let [stdout, stderr] = [out, err].map(|file| fs::read(file.path()).expect("what it wrote"));
    Output { status, stdout, stderr }
}

fn address(page: &Path) -> String {
    format!("file://{}", page.canonicalize().expect("a page").display())
}

/// Opens a page.
///
/// # Panics
/// Panics if Chromium is missing or fails.
pub fn open(page: &Path) -> Opened {
    let log = tempfile::NamedTempFile::new().expect("a temporary file");
    let output = run(&[
        "--enable-logging=stderr".to_owned(),
        "--log-level=0".to_owned(),
        format!("--log-net-log={}", log.path().display()),
        "--virtual-time-budget=2000".to_owned(),
        "--dump-dom".to_owned(),
        address(page),
    ]);
    let messages = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{messages}");
    let console = messages.lines().filter(|line| line.contains(":CONSOLE")).map(str::to_owned).collect();
    let net = fs::read_to_string(log.path()).expect("a log of the network");
    Opened { dom: String::from_utf8_lossy(&output.stdout).into_owned(), console, fetched: fetched(&net) }
}

/// Hosts that Chromium contacts without any page, and the name that the flags map them to.
const OWN: [&str; 9] = [
    "~notfound",
    "google.com",
    "www.google.com",
    "accounts.google.com",
    "clients2.google.com",
    "update.googleapis.com",
    "content-autofill.googleapis.com",
    "optimizationguide-pa.googleapis.com",
    "redirector.gvt1.com",
];

/// The network addresses in a network log.
fn fetched(log: &str) -> BTreeSet<String> {
    let quoted =
        log.split('"').filter(|text| ["http://", "https://", "ws://", "wss://"].iter().any(|s| text.starts_with(s)));
    let host = |url: &str| url.split(['/', ' ', '\\']).nth(2).unwrap_or_default().to_owned();
    let own = |url: &str| OWN.contains(&host(url).as_str());
    quoted.filter(|url| !own(url)).map(str::to_owned).collect()
}

/// Saves a picture of a page as PNG, for a person to look at.
///
/// # Panics
/// See [`open`].
pub fn picture(page: &Path, to: &Path, [width, height]: [u32; 2], dark: bool) {
    let mut arguments = vec![
        format!("--screenshot={}", to.display()),
        format!("--window-size={width},{height}"),
        "--hide-scrollbars".to_owned(),
    ];
    if dark {
        arguments.push("--blink-settings=preferredColorScheme=0".to_owned());
    }
    arguments.push(address(page));
    let output = run(&arguments);
    assert!(output.status.success() && to.is_file(), "{}", String::from_utf8_lossy(&output.stderr));
}
