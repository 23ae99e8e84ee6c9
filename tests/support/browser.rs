//! Pages opened in headless Chromium: what stands in them then, what the console says, and what was asked of a network.
#![allow(dead_code)] // each test uses its own part

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Programs that will do, the first there is.
const PROGRAMS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];
/// No network of its own, and nothing kept.
const FLAGS: [&str; 15] = [
    "--headless",
    "--no-sandbox",
    // WebGL in software, as machines that run tests have no graphics card.
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
    // Nobody out there is asked, whatever asks; what was asked for is logged all the same.
    "--host-resolver-rules=MAP * ~NOTFOUND",
];
/// Longer than this no page takes.
const PATIENCE: Duration = Duration::from_secs(90);

/// A page as Chromium has it.
#[derive(Debug)]
pub struct Opened {
    /// The document, after everything in it has run.
    pub dom: String,
    /// Errors and warnings of the page on the console, a policy's refusals among them.
    pub console: Vec<String>,
    /// Addresses that a network was asked for, the page itself and what lies in it (`data:`) apart.
    pub fetched: BTreeSet<String>,
}

/// The program.
///
/// # Panics
/// When there is none: ./scripts/setup --test installs it.
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
/// When Chromium is missing, or does not end well.
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

/// Hosts that Chromium asks by itself, with no page at all, and the one that the flags make of them.
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

/// The addresses of a network log that are on a network.
fn fetched(log: &str) -> BTreeSet<String> {
    let quoted =
        log.split('"').filter(|text| ["http://", "https://", "ws://", "wss://"].iter().any(|s| text.starts_with(s)));
    let host = |url: &str| url.split(['/', ' ', '\\']).nth(2).unwrap_or_default().to_owned();
    let own = |url: &str| OWN.contains(&host(url).as_str());
    quoted.filter(|url| !own(url)).map(str::to_owned).collect()
}

/// A picture of a page, as PNG: for a person to look at.
///
/// # Panics
/// As [`open`].
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
