//! `cargo xtask gallery`: renders and draws the built-in scenes into `docs/gallery/` and writes the page that shows them.
//!
//! The figures of the page on explanations are made with them, into `docs/explain/`.
//!
//! A caption is the comment that opens a scene file: its first line is the title, the rest says what the picture shows. A scene
//! without a light is a figure, which is drawn and not rendered.

use std::fs;
use std::path::{Path, PathBuf};

use crate::Outcome;
use crate::arguments::Arguments;
use crate::process;

/// How a picture of the gallery is rendered: wide enough for a page, smoothed as the scene asks; pixels.
const RENDER_OPTIONS: &[&str] = &["--width", "960"];
/// And one whose paths are traced, which takes its time.
const PATH_OPTIONS: &[&str] = &["--width", "640", "--samples", "128"];
/// And the lecture's glass by paths, beside its own picture.
const BESIDE_OPTIONS: &[&str] = &["--width", "480", "--samples", "64"];

/// Figures that `snell view` draws: both volumes side by side.
const VIEWS: &[&str] = &["canonical-volume"];

/// What the page on explanations shows, below `docs/explain/`: the words after `snell`, and the file. Of the seven rays each has one.
const EXPLANATIONS: &[(&[&str], &str)] = &[
    (&["explain", "seven-rays"], "seven-rays.png"),
    (&["render", "seven-rays", "--width", "480", "--map", "depth"], "depth.png"),
    (&["render", "seven-rays", "--width", "480", "--map", "share:refracted"], "refracted.png"),
    (&["render", "seven-rays", "--width", "480", "--map", "share:object=board"], "board.png"),
    (&["render", "total-internal-reflection", "--width", "480", "--map", "tir"], "tir.png"),
];

/// Pictures above this size do not belong into a repository; bytes.
const LARGEST_PICTURE: u64 = 1 << 20;

/// Runs the command line `cargo xtask gallery ...`.
pub fn run(arguments: Arguments) -> Outcome {
    let wanted = arguments.names()?;
    let root = process::root();
    let scenes = root.join("scenes");
    let folder = root.join("docs").join("gallery");
    let snell = process::build_snell()?;
    let names = listed_names(&process::output(process::program(&snell.to_string_lossy()).arg("scenes"))?);
    if names.is_empty() {
        return Err("`snell scenes` lists none".to_owned());
    }
    if let Some(unknown) = wanted.iter().find(|name| !names.contains(name)) {
        return Err(format!("there is no built-in scene `{unknown}`; there are: {}", names.join(", ")));
    }

    // Read all captions before the first picture is rendered: a missing one should not cost minutes.
    let mut entries = Vec::new();
    for name in names {
        let path = find_scene(&scenes, &name).ok_or_else(|| format!("no file scenes/**/{name}.toml"))?;
        let text = fs::read_to_string(&path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        let caption = Caption::of(&text).ok_or_else(|| {
            format!("{}: a scene starts with a comment: `# Title`, then what it shows", path.display())
        })?;
        let has = |wanted: &str| text.lines().any(|line| line.trim_end() == wanted);
        let is_of_paths = has("integrator = \"path\"");
        let is_rendered = is_of_paths || has("[[light]]");
        let is_of_glass = text.contains("dielectric");
        entries.push(Entry { name, caption, is_rendered, is_of_paths, is_of_glass });
    }

    fs::create_dir_all(&folder).map_err(|error| format!("cannot make {}: {error}", folder.display()))?;
    for entry in entries.iter().filter(|entry| wanted.is_empty() || wanted.contains(&entry.name)) {
        println!("{}", entry.name);
        for made in entry.pictures() {
            let picture = folder.join(&made.file);
            let mut command = process::program(&snell.to_string_lossy());
            command.args(&made.words).arg("-o").arg(&picture).args(made.options);
            process::run(&mut command)?;
            let size = fs::metadata(&picture).map_err(|error| format!("{}: {error}", picture.display()))?.len();
            if size > LARGEST_PICTURE {
                return Err(format!(
                    "{}: {size} bytes are too many for a page; {LARGEST_PICTURE} at most",
                    picture.display()
                ));
            }
        }
    }
    if wanted.is_empty() {
        let folder = root.join("docs").join("explain");
        fs::create_dir_all(&folder).map_err(|error| format!("cannot make {}: {error}", folder.display()))?;
        for (words, file) in EXPLANATIONS {
            process::run(process::program(&snell.to_string_lossy()).args(*words).arg("-o").arg(folder.join(file)))?;
        }
    }
    remove_pictures_of_no_scene(&folder, &entries)?;
    let page = folder.join("README.md");
    fs::write(&page, page_text(&entries)).map_err(|error| format!("cannot write {}: {error}", page.display()))?;
    println!("{} pictures in {}", entries.len(), folder.display());
    Ok(())
}

/// The first word of every line that `snell scenes` prints.
fn listed_names(listing: &str) -> Vec<String> {
    listing.lines().filter_map(|line| line.split_whitespace().next()).map(str::to_owned).collect()
}

/// The file `NAME.toml` in `folder` or below it.
fn find_scene(folder: &Path, name: &str) -> Option<PathBuf> {
    let direct = folder.join(format!("{name}.toml"));
    if direct.is_file() {
        return Some(direct);
    }
    let mut below: Vec<PathBuf> = fs::read_dir(folder).ok()?.filter_map(|entry| Some(entry.ok()?.path())).collect();
    below.sort();
    below.iter().filter(|path| path.is_dir()).find_map(|path| find_scene(path, name))
}

fn remove_pictures_of_no_scene(folder: &Path, entries: &[Entry]) -> Outcome {
    let files = fs::read_dir(folder).map_err(|error| format!("cannot read {}: {error}", folder.display()))?;
    for path in files.filter_map(|entry| Some(entry.ok()?.path())) {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let is_made = entries.iter().any(|entry| entry.pictures().iter().any(|made| made.file == name));
        if matches!(ending, "png" | "svg") && !is_made {
            fs::remove_file(&path).map_err(|error| format!("cannot remove {}: {error}", path.display()))?;
        }
    }
    Ok(())
}

/// A scene of the gallery.
#[derive(Debug)]
struct Entry {
    name: String,
    caption: Caption,
    /// It has a light, or paths are traced; else it is only drawn.
    is_rendered: bool,
    /// Its paths are traced.
    is_of_paths: bool,
    /// It has glass, which paths show otherwise than the lecture's recursion.
    is_of_glass: bool,
}

/// A picture of a scene.
#[derive(Debug)]
struct Made<'a> {
    /// The words after `snell` that make it.
    words: Vec<&'a str>,
    /// Where it goes, below the gallery.
    file: String,
    /// What it is, after the scene's title.
    what: &'static str,
    /// With what else it is made for the page.
    options: &'static [&'static str],
}

impl Entry {
    /// Its pictures, in the order in which they are shown.
    fn pictures(&self) -> Vec<Made<'_>> {
        let name = self.name.as_str();
        let mut all = Vec::new();
        if self.is_rendered {
            let options = if self.is_of_paths { PATH_OPTIONS } else { RENDER_OPTIONS };
            all.push(Made { words: vec!["render", name], file: format!("{name}.png"), what: "", options });
        }
        if self.is_rendered && self.is_of_glass && !self.is_of_paths {
            let words = vec!["render", name, "--integrator", "path"];
            all.push(Made { words, file: format!("{name}-path.png"), what: ", by paths", options: BESIDE_OPTIONS });
        }
        let words = if VIEWS.contains(&name) { vec!["view", name, "--format", "svg"] } else { vec!["draw", name] };
        all.push(Made { words, file: format!("{name}.svg"), what: ", drawn", options: &[] });
        all
    }
}

/// What a scene file says about itself.
#[derive(Debug, PartialEq)]
struct Caption {
    title: String,
    /// Paragraphs of Markdown.
    text: Vec<String>,
}

impl Caption {
    /// The comment at the top of a scene file; `None` where it has no title or says nothing more.
    fn of(scene: &str) -> Option<Self> {
        let mut lines = scene.lines().map_while(|line| line.strip_prefix('#')).map(str::trim);
        let title = lines.next().filter(|title| !title.is_empty())?.trim_end_matches('.').to_owned();
        let mut text = vec![String::new()];
        for line in lines {
            match text.last_mut() {
                Some(paragraph) if !line.is_empty() => {
                    if !paragraph.is_empty() {
                        paragraph.push(' ');
                    }
                    *paragraph += line;
                }
                _ => text.push(String::new()),
            }
        }
        text.retain(|paragraph| !paragraph.is_empty());
        (!text.is_empty()).then_some(Self { title, text })
    }
}

fn page_text(entries: &[Entry]) -> String {
    let mut page =
        "# Gallery\n\nEvery picture is a scene that ships inside `snell`, and the command under it makes it. \
                    This page is written by `cargo xtask gallery`; change the scene, not the page.\n"
            .to_owned();
    for entry in entries {
        let caption = &entry.caption;
        page += &format!("\n## {}\n", caption.title);
        let mut lines = String::new();
        for Made { words, file, what, .. } in entry.pictures() {
            page += &format!("\n![{}{what}]({file})\n", caption.title);
            lines += &format!("snell {} -o {file}\n", words.join(" "));
        }
        for paragraph in &caption.text {
            page += &format!("\n{paragraph}\n");
        }
        page += &format!("\n```sh\n{lines}```\n");
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_caption_is_the_opening_comment() {
        let scene = "# One glass sphere.\n# The board is seen\n# upside down.\n#\n# After the slides.\n\n# no caption\n[image]\n";
        let caption = Caption::of(scene).expect("it has one");
        assert_eq!(caption.title, "One glass sphere");
        assert_eq!(caption.text, ["The board is seen upside down.", "After the slides."]);
    }

    #[test]
    fn a_scene_that_says_nothing_has_no_caption() {
        for scene in ["", "[image]\n# late\n", "# Only a title\n[image]\n", "#\n# no title\n", "# Title\n#\n"] {
            assert_eq!(Caption::of(scene), None, "{scene:?}");
        }
    }

    #[test]
    fn the_page_shows_each_picture_with_its_command() {
        let entry = |name: &str, is_rendered| {
            let caption = Caption { title: "A".to_owned(), text: vec!["b".to_owned()] };
            Entry { name: name.to_owned(), caption, is_rendered, is_of_paths: false, is_of_glass: name == "one" }
        };
        let page = page_text(&[entry("one", true), entry("two", false), entry("canonical-volume", false)]);
        let parts = [
            "## A\n",
            "(one.png)",
            "(one.svg)",
            "\nb\n",
            "(one-path.png)",
            "snell render one -o one.png\nsnell render one --integrator path -o one-path.png\nsnell draw one -o one.svg\n",
            "(two.svg)",
            "snell view canonical-volume --format svg -o",
        ];
        for part in parts {
            assert!(page.contains(part), "{part} in {page}");
        }
        assert!(!page.contains("two.png"), "{page}");
    }

    #[test]
    fn scenes_are_found_in_folders_too() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::create_dir(folder.path().join("below")).expect("made");
        fs::write(folder.path().join("below/deep.toml"), "").expect("written");
        assert!(find_scene(folder.path(), "deep").is_some());
        assert_eq!(find_scene(folder.path(), "other"), None);
        assert_eq!(listed_names("one  what it shows\n\ntwo\n"), ["one", "two"]);
    }
}
