//! The pages of `--format html` in a real browser: nothing is loaded, nothing is complained of, the first screen answers what a
//! reader asks, and what is folded is printed. Where Chromium is not installed this is said, and nothing fails.

use crate::support::{EXAMPLE, PLANT, answer, every, refuted_witness};
use serde_json::Value;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::LazyLock;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const AT_REST: &str = "specs/paper-example-at-rest.json";

/// A browser that does not answer within this time is broken.
const PATIENCE: Duration = Duration::from_secs(120);

/// The browser; without one, a line on standard error says what was not tested.
fn chromium(test: &str) -> Option<PathBuf> {
    static FOUND: LazyLock<Option<PathBuf>> = LazyLock::new(|| {
        let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
        let names = ["chromium", "chromium-browser", "google-chrome"];
        names.iter().find_map(|name| folders.iter().map(|folder| folder.join(name)).find(|path| path.is_file()))
    });
    if FOUND.is_none() {
        // The test harness keeps what passing tests print; this goes past it.
        let _ = writeln!(std::io::stderr(), "chromium::{test} was not run: Chromium is not installed");
    }
    FOUND.clone()
}

/// What the browser wrote for a page: its output, and what the console says of pages.
fn browse(browser: &Path, page: &Path, arguments: &[&str]) -> (String, Vec<String>) {
    let folder = TempDir::new().unwrap();
    let streams = ["out", "log"].map(|name| folder.path().join(name));
    let [out, log] = streams.each_ref().map(|path| Stdio::from(fs::File::create(path).unwrap()));
    let profile = folder.path().join("profile");
    let mut child = Command::new(browser)
        .args("--headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking".split(' '))
        .args("--disable-component-update --disable-sync --hide-scrollbars --enable-logging=stderr".split(' '))
        // No name of a host is ever looked up.
        .arg("--host-resolver-rules=MAP * ~NOTFOUND")
        .arg(format!("--user-data-dir={}", profile.display()))
        .args(arguments)
        .arg(format!("file://{}", page.display()))
        .stdout(out)
        .stderr(log)
        .spawn()
        .expect("the browser starts");
    let start = Instant::now();
    let status = loop {
        match child.try_wait().unwrap() {
            Some(status) => break status,
            None if start.elapsed() > PATIENCE => {
                let _ = child.kill();
                panic!("the browser does not end: {arguments:?}");
            }
            None => std::thread::sleep(Duration::from_millis(20)),
        }
    };
    let [out, log] = streams.map(|path| String::from_utf8_lossy(&fs::read(path).unwrap()).into_owned());
    assert!(status.success(), "{status}: {log}");
    (out, log.lines().filter(|line| line.contains(":CONSOLE")).map(str::to_owned).collect())
}

/// The pages of a page printed to PDF.
fn printed(browser: &Path, page: &Path) -> (usize, Vec<String>) {
    let file = page.with_extension("pdf");
    let (_, console) =
        browse(browser, page, &["--no-pdf-header-footer", &format!("--print-to-pdf={}", file.display())]);
    let pdf = fs::read(file).expect("printed");
    let object = b"/Type /Page\n";
    (pdf.windows(object.len()).filter(|window| window == object).count(), console)
}

/// A report as a page in a folder.
fn page(folder: &Path, name: &str, arguments: &[&str], code: i32) -> PathBuf {
    let output = answer(&[arguments, &["--format", "html"]].concat());
    assert_eq!(output.status.code(), Some(code), "{arguments:?}");
    let path = folder.join(format!("{name}.html"));
    fs::write(&path, &output.stdout).unwrap();
    path
}

/// Every kind of report, written once.
fn every_page() -> &'static [PathBuf] {
    static PAGES: LazyLock<Vec<PathBuf>> = LazyLock::new(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pages");
        fs::create_dir_all(&folder).expect("a folder for tests");
        pages(&folder)
    });
    &PAGES
}

/// With their names and exit codes.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let certificate = folder.join("certificate.json");
    let certificate = certificate.to_str().expect("a plain name");
    let claim = page(folder, "certify", &["certify", EXAMPLE, "-q", "--force", "-o", certificate], 0);
    let jacobian = "specs/paper-example-jacobian.json";
    let others: [(&str, &[&str], i32); 13] = [
        ("plant", &["certify", PLANT, "-q"], 0),
        ("sampled", &["certify", AT_REST, "-q", "--sampling-period", "1/1000"], 0),
        ("refuted", &["certify", EXAMPLE, "-q", "--witness", refuted_witness()], 1),
        ("transfer", &["transfer", EXAMPLE, "-q", "--n-o", "0,1,2,5,10,inf"], 0),
        ("lyapunov", &["lyapunov", jacobian], 0),
        ("sampling", &["sampling", AT_REST, "-q", "--sampling-period", "1/1000", "--sigma", "1,25"], 0),
        ("simulate", &["simulate", PLANT, "-q", "--sigma", "2", "--n-o", "2", "--periods", "2"], 0),
        ("falsify", &["falsify", certificate, "-q", "--trials", "2"], 0),
        ("check", &["check", certificate], 0),
        ("errata", &["errata", EXAMPLE], 0),
        ("constants", &["constants", EXAMPLE], 0),
        ("design", &["design", EXAMPLE, "-q", "--sigma", "50", "--n-o", "0"], 0),
        ("tune", &["tune", EXAMPLE, "-q", "--over", "mu", "--tries", "8"], 0),
    ];
    let others = others.iter().map(|(name, arguments, code)| page(folder, name, arguments, *code));
    [claim].into_iter().chain(others).collect()
}

#[test]
fn pages_load_nothing_and_print_what_is_folded() {
    let Some(browser) = chromium("pages_load_nothing_and_print_what_is_folded") else { return };
    // One browser loads them all in frames; to print takes one for each.
    let frames: Vec<_> = every_page().iter().map(|page| (page.clone(), 1400, 900)).collect();
    let (_, console) = framed(&browser, &frames);
    assert!(console.is_empty(), "{console:?}");
    for page in every_page().iter().step_by(every(6)) {
        let (pages, console) = printed(&browser, page);
        assert!(console.is_empty(), "{}: {console:?}", page.display());
        assert!(pages > 0, "{}", page.display());
        let text = fs::read_to_string(page).unwrap();
        if text.contains("<details>") {
            let opened = page.with_extension("open.html");
            fs::write(&opened, text.replace("<details>", "<details open>")).unwrap();
            assert_eq!(printed(&browser, &opened).0, pages, "{}", page.display());
        }
    }
}

/// The test above would see a page that loads something, that complains, or that keeps what is folded to itself.
#[test]
fn a_bad_page_is_seen() {
    let Some(browser) = chromium("a_bad_page_is_seen") else { return };
    let folder = TempDir::new().unwrap();
    let policy = "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'\">";
    let image = "<img src=\"http://192.0.2.1/x.png\" alt=\"\">";
    let folded = format!("<details><summary>a</summary>{}</details>", "<p>b</p>".repeat(200));
    let cases = [
        (policy, "<p>a</p>".to_owned(), 0, 1),
        (policy, image.to_owned(), 1, 1),
        ("", "<script>console.warn('careful')</script>".to_owned(), 1, 1),
        ("", folded.clone(), 0, 1),
        ("", folded.replace("<details>", "<details open>"), 0, 5),
    ];
    let mut frames = Vec::new();
    for (at, (head, body, complaints, pages)) in cases.iter().enumerate() {
        let page = folder.path().join(format!("page-{at}.html"));
        fs::write(&page, format!("<!DOCTYPE html><html><head>{head}</head><body>{body}</body></html>")).unwrap();
        let (printed, console) = printed(&browser, &page);
        assert_eq!(console.len(), *complaints, "{body}: {console:?}");
        assert!(if *pages == 1 { printed == 1 } else { printed >= *pages }, "{printed}: {body}");
        frames.push((page, 400, 800));
    }
    let (_, console) = framed(&browser, &frames);
    assert_eq!(console.len(), cases.iter().map(|(_, _, complaints, _)| complaints).sum::<usize>(), "{console:?}");
}

/// Where the answers on a page end, in its own pixels, and how wide it is.
const MEASURE: &str = r"<script>
addEventListener('load', () => {
  const first = document.querySelector('section');
  const facts = [...first.querySelectorAll('dt')].filter(dt => ['gain', 'from', 'next'].includes(dt.textContent));
  const lists = [...first.querySelectorAll('ul')];
  const advice = lists.length ? [lists[lists.length - 1].querySelector('li')] : [];
  const verdict = [...first.querySelectorAll('.verdict')];
  const answers = [...verdict, ...(facts.length ? facts.map(dt => dt.nextElementSibling) : advice)];
  parent.postMessage({
    answers: answers.length, bottom: Math.max(0, ...answers.map(a => a.getBoundingClientRect().bottom)),
    width: document.documentElement.scrollWidth, inner: innerWidth,
  }, '*');
});
</script></head>";

/// What the pages of frames of these sizes tell the page around them, and what the console says of all.
fn framed(browser: &Path, frames: &[(PathBuf, u32, u32)]) -> (Vec<Value>, Vec<String>) {
    let outer = frames[0].0.with_extension("outer.html");
    let listen = "const said = {}; addEventListener('message', m => {
        const all = [...document.querySelectorAll('iframe')];
        said[all.findIndex(frame => frame.contentWindow === m.source)] = m.data; document.title = JSON.stringify(said);
    })";
    let frame = |(page, width, height): &(PathBuf, u32, u32)| {
        let name = page.file_name().and_then(|name| name.to_str()).expect("a plain name");
        format!("<iframe width=\"{width}\" height=\"{height}\" style=\"border:0\" src=\"{name}\"></iframe>")
    };
    let frames: String = frames.iter().map(frame).collect();
    let page = format!("<!DOCTYPE html><html><head><title>{{}}</title><script>{listen}</script></head><body>{frames}");
    fs::write(&outer, page + "</body></html>").unwrap();
    let (dom, console) = browse(browser, &outer, &["--virtual-time-budget=3000", "--dump-dom"]);
    let title = dom.split_once("<title>").and_then(|(_, rest)| rest.split_once("</title>")).map(|(title, _)| title);
    let title = title.unwrap_or_else(|| panic!("no answer: {console:?} {dom}"));
    let said: Value = serde_json::from_str(&title.replace("&quot;", "\"")).expect("JSON");
    ((0..).map_while(|index: usize| said.get(index.to_string()).cloned()).collect(), console)
}

/// Of each page in a window of a size: the number of answers, where the last of them ends, and by how much the page is wider.
fn measured(browser: &Path, pages: &[(&Path, u32, u32)]) -> Vec<(u64, f64, f64)> {
    // The copy that is measured may run the script; a frame is as narrow as it is told, unlike a window.
    let copy = |(page, width, height): &(&Path, u32, u32)| {
        let text = fs::read_to_string(page).unwrap();
        let text = text.replace("<meta http-equiv", "<meta name").replace("</head>", MEASURE);
        let inner = page.with_extension("inner.html");
        fs::write(&inner, text).unwrap();
        (inner, *width, *height)
    };
    let (said, console) = framed(browser, &pages.iter().map(copy).collect::<Vec<_>>());
    assert_eq!(said.len(), pages.len(), "{console:?}");
    let number = |said: &Value, name: &str| said[name].as_f64().expect("a number");
    let one = |((_, width, _), said): (&(&Path, u32, u32), &Value)| {
        assert_eq!(said["inner"], *width);
        let overflow = number(said, "width") - number(said, "inner");
        (said["answers"].as_u64().expect("a number"), number(said, "bottom"), overflow)
    };
    pages.iter().zip(&said).map(one).collect()
}

/// What is certified, with what gain, from where, what to do next: without scrolling, on a telephone and on a desk. Without a
/// claim: what was not certified and why, and what to try.
#[test]
fn the_first_screen_answers_what_a_reader_asks() {
    let Some(browser) = chromium("the_first_screen_answers_what_a_reader_asks") else { return };
    let folder = TempDir::new().unwrap();
    let cases: [(&str, &[&str], i32, u64); 6] = [
        ("claim", &["certify", EXAMPLE, "-q"], 0, 4),
        ("plant", &["certify", PLANT, "-q"], 0, 4),
        ("sampled", &["certify", AT_REST, "-q", "--sampling-period", "1/1000"], 0, 4),
        ("sampled-undecided", &["certify", AT_REST, "-q", "--sampling-period", "1/10"], 3, 2),
        ("undecided", &["certify", EXAMPLE, "-q", "--sigma", "30"], 3, 2),
        ("refuted", &["certify", EXAMPLE, "-q", "--witness", refuted_witness()], 1, 2),
    ];
    let pages = cases.map(|(name, arguments, code, _)| page(folder.path(), name, arguments, code));
    let mut windows: Vec<(&Path, u32, u32)> = Vec::new();
    for page in &pages {
        windows.extend([(page.as_path(), 400, 800), (page.as_path(), 1400, 900)]);
    }
    // On a screen that is too low the answers end below.
    windows.push((&pages[0], 400, 200));
    let mut found = measured(&browser, &windows);
    assert!(found.pop().is_some_and(|(_, bottom, _)| bottom > 200.0));
    for (at, ((answers, bottom, overflow), (_, width, height))) in found.into_iter().zip(&windows).enumerate() {
        let (name, .., expected) = cases[at / 2];
        assert_eq!(answers, expected, "{name}");
        assert!(bottom <= f64::from(*height), "{name} at {width}: the answers end at {bottom}");
        assert!(overflow <= 0.0, "{name} at {width}: {overflow} pixels too wide");
    }
}

/// No page is wider than a telephone: tables and figures scroll in themselves.
#[test]
fn no_page_is_wider_than_its_window() {
    let Some(browser) = chromium("no_page_is_wider_than_its_window") else { return };
    let windows: Vec<_> = every_page().iter().map(|page| (page.as_path(), 400, 800)).collect();
    for (page, (_, _, overflow)) in every_page().iter().zip(measured(&browser, &windows)) {
        assert!(overflow <= 0.0, "{}: {overflow} pixels too wide", page.display());
    }
}
