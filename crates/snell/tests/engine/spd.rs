//! The Standard Procedural Databases by their rules: the numbers of rays against Eric Haines's published ones.
//!
//! `tests/data/spd_ray_counts.csv` says where the numbers are from. Ours agree within 1 %, where the Readme expects 10 %, with
//! two exceptions that have reasons, given in [`Published::tolerance`].

use snell::scene::reader::nff;
use snell::statistics::Statistics;
use snell_testkit::{long_tests, must_fail};

use crate::files::root;
use crate::stage::Stage;

/// One row of the table.
#[derive(Clone, Debug)]
struct Published {
    database: String,
    eye_hits: u64,
    reflected: u64,
    refracted: u64,
    shadow: u64,
}

/// The table.
fn published() -> Vec<Published> {
    let table = include_str!("../data/spd_ray_counts.csv");
    let rows = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|row| {
        let fields: Vec<&str> = row.split(',').collect();
        let number = |index: usize| fields[index].parse().expect("a number");
        let database = fields[0].to_owned();
        Published { database, eye_hits: number(3), reflected: number(4), refracted: number(5), shadow: number(6) }
    })
    .collect()
}

/// The scene of a file of the databases; `None`, with a message, where they are not there.
fn stage(file: &str) -> Option<Stage> {
    let path = root().join("../shared/assets/spd-nff").join(file);
    let Ok(bytes) = std::fs::read(&path) else {
        eprintln!("skipped: there is no {}", path.display());
        return None;
    };
    let (scene, told) = nff::read(file, &bytes);
    let mut scene = scene.unwrap_or_else(|| panic!("{file}: {:?}", told.list));
    nff::spd_rules(&mut scene);
    Some(Stage::of(&scene))
}

/// Renders by the rules; the counts, and how many camera rays hit something.
fn count(stage: &mut Stage) -> (Statistics, u64) {
    stage.settings.layers = true;
    let rendering = stage.render();
    let objects = rendering.layers.and_then(|layers| layers.object).expect("asked for");
    (rendering.statistics, objects.pixels().iter().filter(|object| **object != 0).count() as u64)
}

impl Published {
    /// How far our numbers may be from these, as a share.
    fn tolerance(&self) -> f64 {
        match self.database.as_str() {
            // The file at hand has size 6, the table's teapot 12: another silhouette, and other normals.
            "teapot" => 0.015,
            _ => 0.01,
        }
    }

    #[track_caller]
    fn agrees(&self, (ours, eye_hits): &(Statistics, u64)) {
        let Self { database, reflected, refracted, shadow, .. } = self;
        assert_eq!((ours.camera_rays, ours.nonfinite_samples), (513 * 513, 0));
        let near = |kind: &str, our: u64, their: u64| {
            let difference = if our == their { 0.0 } else { our as f64 / their as f64 - 1.0 };
            assert!(difference.abs() < self.tolerance(), "{database}: {our} {kind} and not {their}: {difference:+.4}");
        };
        near("camera rays that hit", *eye_hits, self.eye_hits);
        near("reflected rays", ours.reflected_rays, *reflected);
        near("shadow rays", ours.shadow_rays, *shadow);
        if ours.total_internal_reflections == 0 {
            near("refracted rays", ours.refracted_rays, *refracted);
        } else {
            // In the published counts of gears there is a refracted ray for every reflected one of a transparent surface,
            // as if light never met total internal reflection; with ours that did, the numbers agree again. Those at
            // the greatest depth spawn nothing in any case.
            let with_total = ours.refracted_rays + ours.total_internal_reflections;
            let range = ours.refracted_rays..=with_total;
            assert!(range.contains(refracted), "{database}: {range:?} refracted rays and not {refracted}");
        }
    }
}

/// Prints one row of the comparison, for those who look at the output.
fn print(row: &Published, (ours, eye_hits): &(Statistics, u64)) {
    let cell = |our: u64, their: u64| {
        let percent = if our == their { 0.0 } else { 100.0 * (our as f64 / their as f64 - 1.0) };
        format!("{our:>8} {percent:+6.2} %")
    };
    println!(
        "{:7} hit {} reflected {} refracted {} shadow {} total {}",
        row.database,
        cell(*eye_hits, row.eye_hits),
        cell(ours.reflected_rays, row.reflected),
        cell(ours.refracted_rays, row.refracted),
        cell(ours.shadow_rays, row.shadow),
        ours.total_internal_reflections,
    );
}

#[test]
fn counts_of_rays_agree_with_the_published_ones() {
    let all = long_tests("ray counts of five of the seven databases");
    for row in published() {
        if !all && !matches!(row.database.as_str(), "tetra" | "mount") {
            continue;
        }
        let Some(mut stage) = stage(&format!("{}-default.nff", row.database)) else { return };
        let ours = count(&mut stage);
        print(&row, &ours);
        row.agrees(&ours);
    }
}

#[test]
fn rules_that_are_not_kept_are_told() {
    let Some(mut stage) = stage("mount-default.nff") else { return };
    let row = published().into_iter().find(|row| row.database == "mount").expect("in the table");
    stage.settings.depth = 4;
    let ours = count(&mut stage);
    let message = must_fail("a depth of four", || row.agrees(&ours));
    assert!(message.contains("reflected rays"), "{message}");
}

#[test]
fn rays_without_weight_are_counted_by_the_rules_alone() {
    // Gears transmit and reflect nothing.
    let nff = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 30\nhither 1\nresolution 512 512\nl 3 4 5\n\
               f 1 1 1 0.5 0 0 0.8 1.1\ns 0 0 0 1\n";
    let mut scene = nff::read("glass.nff", nff.as_bytes()).0.expect("a scene");
    let counts = |scene: &snell::scene::Scene| Stage::of(scene).sized(33, 33).render();
    let plain = counts(&scene);
    assert_eq!(plain.statistics.reflected_rays, 0);
    assert!(plain.statistics.refracted_rays > 0);
    nff::spd_rules(&mut scene);
    scene.settings.pixel_grid = snell::scene::scene::PixelGrid::Centers;
    let ruled = counts(&scene);
    assert!(ruled.statistics.reflected_rays >= ruled.statistics.refracted_rays);
    crate::stage::assert_pictures(&ruled.image, &plain.image, 0.0);
}
