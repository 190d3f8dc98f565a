//! Which room of the engine (`crates/snell/src/ROOM`) may know which.
//!
//! The leaves know only mathematics, the scene and images; `accel` <- `geometry` <- `compile` <- `integrator` <- `trace` <-
//! `render`. `task` is what travels between them.
//! Tests may look anywhere. Change this table on purpose: it is the architecture.

use super::paths::paths;
use super::source::line_at;
use super::{Report, Tree};

/// Where the rooms are.
const ENGINE: &str = "crates/snell/src/";

/// What every room may use: the crates below, re-exported at the root.
const FOUNDATION: &[&str] = &["math", "scene", "image"];

/// A room and those it may use.
struct Room {
    name: &'static str,
    may_use: &'static [&'static str],
}

/// From the leaves to the door; a room only ever uses rooms above it in this list.
const ROOMS: &[Room] = &[
    Room { name: "viewing", may_use: &[] },
    Room { name: "vector", may_use: &[] },
    Room { name: "plot", may_use: &["viewing", "vector"] },
    Room { name: "accel", may_use: &[] },
    Room { name: "shape", may_use: &[] },
    Room { name: "csg", may_use: &["shape"] },
    // The curves that shapes and solids are drawn by.
    Room { name: "outline", may_use: &["shape", "csg"] },
    Room { name: "optics", may_use: &[] },
    Room { name: "texture", may_use: &[] },
    Room { name: "light", may_use: &[] },
    // How neighbouring rays differ.
    Room { name: "differential", may_use: &[] },
    Room { name: "camera", may_use: &["viewing", "differential"] },
    Room { name: "film", may_use: &[] },
    Room { name: "statistics", may_use: &[] },
    // Patterns are read a little inside the surface, by as much as textures say.
    Room { name: "interaction", may_use: &["texture", "differential"] },
    // Metals are known by their indices.
    Room { name: "material", may_use: &["texture", "interaction", "optics"] },
    Room { name: "task", may_use: &["interaction", "differential"] },
    Room { name: "observe", may_use: &["interaction", "material", "task"] },
    Room { name: "geometry", may_use: &["accel", "shape", "csg", "texture", "differential", "interaction", "task"] },
    Room {
        name: "compile",
        may_use: &[
            "accel",
            "shape",
            "csg",
            "texture",
            "light",
            "camera",
            "differential",
            "interaction",
            "material",
            "task",
            "geometry",
        ],
    },
    Room {
        name: "integrator",
        may_use: &[
            // Lights are surfaces that are sampled.
            "shape",
            "optics",
            "texture",
            "light",
            "camera",
            "differential",
            "statistics",
            "interaction",
            "material",
            "task",
            "observe",
            "geometry",
            "compile",
        ],
    },
    Room {
        name: "drawing",
        may_use: &["viewing", "vector", "plot", "shape", "outline", "camera", "geometry", "compile"],
    },
    Room {
        name: "trace",
        may_use: &[
            "optics",
            "differential",
            "statistics",
            "interaction",
            "task",
            "observe",
            "geometry",
            "compile",
            "integrator",
        ],
    },
    Room {
        name: "render",
        may_use: &[
            "viewing",
            "camera",
            "differential",
            "film",
            "statistics",
            "task",
            "observe",
            "geometry",
            "compile",
            "integrator",
            "trace",
        ],
    },
    // What the watched code told, put into words' order and drawn.
    Room {
        name: "explain",
        may_use: &[
            "viewing",
            "vector",
            "optics",
            "camera",
            "film",
            "interaction",
            "task",
            "observe",
            "geometry",
            "compile",
            "drawing",
            "trace",
            "render",
        ],
    },
];

/// Single files that may use one room more, each with its reason.
const EXCEPTIONS: &[(&str, &str)] = &[
    // A mesh is a shape made of very many; it needs a hierarchy of its own to be one.
    ("shape/triangle_mesh", "accel"),
];

/// No room of the engine uses another that it must not know.
pub fn rooms_know_only_what_they_may(tree: &Tree, report: &mut Report) {
    for (path, source) in tree.rust() {
        let Some(inside) = path.strip_prefix(ENGINE).filter(|inside| *inside != "lib.rs") else { continue };
        let modules = modules_of(inside);
        let Some(room) = ROOMS.iter().find(|room| Some(&room.name) == modules.first()) else {
            let message = "this room is not in the table of xtask/src/tidy/rooms.rs";
            report.problem("rooms", path, 1, message);
            continue;
        };
        for found in paths(&source.shipped, &["crate", "super"]) {
            let Some(used) = used_from_root(&modules, &found.segments) else { continue };
            let is_exception = EXCEPTIONS.iter().any(|(file, room)| inside.starts_with(file) && *room == used);
            let is_allowed =
                used == room.name || room.may_use.contains(&used) || FOUNDATION.contains(&used) || is_exception;
            if !is_allowed {
                let line = line_at(&source.shipped, found.offset);
                let message = if ROOMS.iter().any(|room| room.name == used) {
                    format!("`{}` must not know `{used}`: see xtask/src/tidy/rooms.rs", room.name)
                } else {
                    format!("`crate::{used}` names no room: say which it comes from")
                };
                report.problem("rooms", path, line, message);
            }
        }
    }
}

/// `shape/mod.rs` and `shape.rs` are `[shape]`, `shape/mesh.rs` is `[shape, mesh]`.
fn modules_of(inside: &str) -> Vec<&str> {
    let path = inside.strip_suffix(".rs").unwrap_or(inside);
    path.strip_suffix("/mod").unwrap_or(path).split('/').collect()
}

/// The first name below the crate's root that a path means; `None` where it stays below.
fn used_from_root<'c>(modules: &[&str], segments: &[&'c str]) -> Option<&'c str> {
    let supers = segments.iter().take_while(|segment| **segment == "super").count();
    if supers == 0 {
        return segments.get(1).copied().filter(|used| *used != "self");
    }
    // Inside an inline module one `super` less leads to the root; so only the name of a room is taken for one.
    let used = segments.get(supers).copied()?;
    (supers >= modules.len() && ROOMS.iter().any(|room| room.name == used)).then_some(used)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_room_uses_only_rooms_above_it_so_there_is_no_circle() {
        for (index, room) in ROOMS.iter().enumerate() {
            for used in room.may_use {
                assert!(ROOMS[..index].iter().any(|above| above.name == *used), "{} uses {used}", room.name);
            }
        }
        for (file, used) in EXCEPTIONS {
            let place = |name: &str| ROOMS.iter().position(|room| room.name == name);
            assert!(place(used) < place(modules_of(file)[0]), "{file} uses {used}");
        }
    }

    #[test]
    fn parents_lead_to_the_root() {
        assert_eq!(modules_of("shape/mod.rs"), ["shape"]);
        assert_eq!(modules_of("shape/mesh.rs"), ["shape", "mesh"]);
        assert_eq!(used_from_root(&["shape"], &["super", "accel", "Bvh"]), Some("accel"));
        assert_eq!(used_from_root(&["shape", "mesh"], &["super", "accel"]), None);
        assert_eq!(used_from_root(&["shape", "mesh"], &["super", "super", "accel"]), Some("accel"));
        assert_eq!(used_from_root(&["shape"], &["crate", "accel"]), Some("accel"));
    }
}
