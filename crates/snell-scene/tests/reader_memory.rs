//! Readers allocate in proportion to the bytes that are really there, whatever a file promises: measured with an allocator
//! that counts. One test, so that nothing else allocates meanwhile.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};

use snell_scene::Diagnostics;
use snell_scene::assets::MemoryAssets;
use snell_scene::reader::{nff, read_mesh};

struct Counting;

static NOW: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

// SAFETY: everything is handed on to the system's allocator; only sizes are counted.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        PEAK.fetch_max(NOW.fetch_add(layout.size(), Relaxed) + layout.size(), Relaxed);
        // SAFETY: the caller keeps the contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller keeps the contract.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Reads a file and says how much memory it took at its peak, in bytes, and how long.
fn measure(name: &str, bytes: &[u8], library: &[u8]) -> (usize, Duration) {
    let assets = MemoryAssets::default().with("a.mtl", library);
    let (before, start) = (NOW.load(Relaxed), Instant::now());
    PEAK.store(before, Relaxed);
    if name.ends_with("nff") {
        drop(nff::read(name, bytes));
    } else {
        let mut diagnostics = Diagnostics::default();
        drop(read_mesh(name, bytes, &assets, &mut diagnostics));
    }
    (PEAK.load(Relaxed) - before, start.elapsed())
}

/// A binary or ascii PLY header.
fn ply(format: &str, vertices: u64, faces: u64, list: &str) -> Vec<u8> {
    format!(
        "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {faces}\nproperty list {list} vertex_indices\nelement other 4000000000\nend_header\n"
    )
    .into_bytes()
}

/// Name, content, and the library a.mtl.
fn hostile_files() -> Vec<(&'static str, Vec<u8>, Vec<u8>)> {
    let n = 20_000;
    let many = |line: &str| line.repeat(n).into_bytes();
    let word = "x".repeat(300_000);
    let binary = "binary_little_endian";
    let alone = |name: &'static str, bytes: Vec<u8>| (name, bytes, Vec::new());
    vec![
        alone("a.ply", ply(binary, 4_000_000_000, 0, "uchar int")),
        alone("a.ply", ply("ascii", 0, 4_000_000_000, "uchar int")),
        alone("a.ply", [ply(binary, 0, 100_000, "uchar int"), vec![0; 100_000]].concat()),
        alone("a.ply", [ply(binary, 1, 100_000, "uchar uchar"), vec![0; 12], [3, 0, 0, 0].repeat(100_000)].concat()),
        alone("a.ply", [ply(binary, 1, 1, "uint uchar"), vec![0; 12], vec![0xff; 100_000]].concat()),
        alone("a.ply", [ply("ascii", 1, 1, "uint uchar"), many("0 0 0 ")].concat()),
        alone("a.stl", [vec![0; 80], vec![0xff; 4], vec![0; 50 * n]].concat()),
        alone("a.stl", many("solid\nfacet\nvertex 1 2 3\nvertex 4 5 6\nvertex 7 8 9\nendfacet\n")),
        alone("a.obj", [b"v 0 0 0\n".to_vec(), many("f 1 1 1\n")].concat()),
        alone("a.obj", [b"v 0 0 0\nf".to_vec(), many(" 1")].concat()),
        alone("a.obj", [b"v 0 0 0\n".to_vec(), many("usemtl a\nf 1 1 1\nusemtl b\nf 1 1 1\n")].concat()),
        ("a.obj", b"v 0 0 0\nmtllib a.mtl\nusemtl q\nf 1 1 1\n".to_vec(), many("newmtl q\n")),
        (
            "a.obj",
            format!("mtllib a.mtl\nusemtl {word}\nv 0 0 0\nf 1 1 1\n").into_bytes(),
            format!("newmtl {word}y").into_bytes(),
        ),
        alone("a.obj", many("mtllib a b c d e\n")),
        alone("a.obj", many("v 0\n")),
        alone("a.obj", format!("{word} 1\n").repeat(4).into_bytes()),
        alone("a.nff", many("s 0 0 0 1\n")),
        alone("a.nff", many("f 1 1 1 1 1 1 1 1 s 0 0 0 1 f 1 1 1 1 1 1 1 2 s 0 0 0 1\n")),
        alone("a.nff", many("l 1 1 1\n")),
        alone("a.nff", b"p 4000000000\n1 2 3\n".to_vec()),
    ]
}

#[test]
fn memory_and_time_follow_the_bytes_that_are_there() {
    // The counter sees what it should: a planted waste.
    let before = NOW.load(Relaxed);
    PEAK.store(before, Relaxed);
    drop(std::hint::black_box(vec![1u8; 10_000_000]));
    assert!(PEAK.load(Relaxed) - before >= 10_000_000);

    for (name, bytes, library) in hostile_files() {
        let size = bytes.len() + library.len();
        let (peak, time) = measure(name, &bytes, &library);
        let start = String::from_utf8_lossy(&bytes[..bytes.len().min(60)]).into_owned();
        println!("{name} {size} bytes: {:.1} bytes a byte, {time:?}: {start:?}", peak as f64 / size as f64);
        assert!(peak < 120 * size + 200_000, "{name}: {peak} bytes for {size}: {start:?}");
        assert!(time < Duration::from_secs(5), "{name}: {time:?}: {start:?}");
    }
}
