//! The rows of a PLY file: vertices, faces and strips are kept, other elements skipped.
//!
//! No row is read and nothing allocated before the bytes that the header's counts ask for are known to be there.

use super::header::{Element, Header, Kind, Property, Scalar};
use super::source::{Fail, Source};
use super::{Data, linear};
use crate::diagnostic::Diagnostic;
use crate::reader::report::{Report, quoted};

/// Reads all rows; `None` where they cannot be used, which the report says.
pub(super) fn read<S: Source>(header: &Header, source: &mut S, report: &mut Report<'_>) -> Option<Data> {
    let vertices = header.elements.iter().find(|e| e.name == "vertex").map_or(0, |e| e.count);
    check_vertex_properties(header, report)?;
    let mut data = Data::default();
    for element in &header.elements {
        if !fits(element, source, report) {
            return None;
        }
        let read = match element.name.as_str() {
            "vertex" => read_vertices(element, source, report, &mut data),
            "face" | "tristrips" if vertex_list(element).is_some() => {
                read_faces(element, vertices, source, report, &mut data)
            }
            _ => source.skip(element).map_err(|fail| (fail, 0)),
        };
        if let Err((fail, row)) = read {
            tell(fail, element, row, report);
            return None;
        }
    }
    (!report.failed()).then_some(data)
}

/// Positions must be declared, each once, as numbers.
fn check_vertex_properties(header: &Header, report: &mut Report<'_>) -> Option<()> {
    let Some(element) = header.elements.iter().find(|e| e.name == "vertex") else {
        report.whole("headers", || Diagnostic::error("the header declares no element `vertex`: there is no mesh"));
        return None;
    };
    if element.count > u64::from(u32::MAX) {
        report
            .at(element.range.clone(), "headers", || Diagnostic::error("more vertices than 32-bit numbers can count"));
    }
    for name in ["x", "y", "z"] {
        let scalars = element.properties.iter().filter(|p| p.name == name && matches!(p.kind, Kind::Scalar(_))).count();
        if scalars != 1 {
            report.at(element.range.clone(), "headers", || {
                Diagnostic::error(format!(
                    "the vertices need exactly one property `{name}`, a number; they have {scalars}"
                ))
            });
        }
    }
    for property in header.elements.iter().filter(|e| e.name == "face").flat_map(|e| &e.properties) {
        if matches!(property.kind, Kind::List { item, .. } if is_vertex_list(property) && !item.is_integer()) {
            let message = "the vertices of a face must be of an integer type";
            report.at(property.range.clone(), "headers", || Diagnostic::error(message));
        }
    }
    (!report.failed()).then_some(())
}

fn is_vertex_list(property: &Property) -> bool {
    matches!(property.name.as_str(), "vertex_indices" | "vertex_index") && matches!(property.kind, Kind::List { .. })
}

fn vertex_list(element: &Element) -> Option<usize> {
    element.properties.iter().position(is_vertex_list)
}

/// True where the file has enough bytes for the rows that the header promises.
fn fits<S: Source>(element: &Element, source: &S, report: &mut Report<'_>) -> bool {
    let least_row: u64 = element
        .properties
        .iter()
        .map(|p| match p.kind {
            Kind::Scalar(scalar) => S::least_size(scalar),
            Kind::List { count, .. } => S::least_size(count),
        })
        .sum();
    let (needed, there) = (element.count.saturating_mul(least_row), source.remaining());
    if needed > there {
        report.at(element.range.clone(), "elements", || {
            Diagnostic::error(format!(
                "the header promises {} rows of {}, at least {needed} bytes, but only {there} bytes follow",
                element.count,
                quoted(element.name.as_bytes()),
            ))
            .help("the file is cut off, or its header is wrong")
        });
    }
    needed <= there
}

/// What one number of a vertex is.
#[derive(Clone, Copy)]
enum Role {
    Position(usize),
    Normal(usize),
    Uv(usize),
    Color(usize),
    None,
}

fn role(name: &str) -> Role {
    match name {
        "x" => Role::Position(0),
        "y" => Role::Position(1),
        "z" => Role::Position(2),
        "nx" => Role::Normal(0),
        "ny" => Role::Normal(1),
        "nz" => Role::Normal(2),
        "s" | "u" | "texture_u" | "texture_s" => Role::Uv(0),
        "t" | "v" | "texture_v" | "texture_t" => Role::Uv(1),
        "red" | "r" | "diffuse_red" => Role::Color(0),
        "green" | "g" | "diffuse_green" => Role::Color(1),
        "blue" | "b" | "diffuse_blue" => Role::Color(2),
        _ => Role::None,
    }
}

/// The last number read must be one that f32 can hold.
fn finite<S: Source>(value: f64, what: &str, row: u64, source: &S, report: &mut Report<'_>) -> f32 {
    let stored = value as f32;
    if !stored.is_finite() {
        report.at(source.place(), "numbers that are not finite", || {
            Diagnostic::error(format!("the {what} of vertex {row} is {value:?}, which is not finite or too large"))
        });
    }
    stored
}

fn read_vertices<S: Source>(
    element: &Element,
    source: &mut S,
    report: &mut Report<'_>,
    data: &mut Data,
) -> Result<(), (Fail, u64)> {
    let roles: Vec<(Kind, Role)> = element.properties.iter().map(|p| (p.kind, role(&p.name))).collect();
    let complete = |wanted: fn(Role) -> Option<usize>, count: usize| {
        let has = |i| roles.iter().any(|(kind, role)| wanted(*role) == Some(i) && matches!(kind, Kind::Scalar(_)));
        (0..count).all(has)
    };
    let has_normals = complete(|r| if let Role::Normal(i) = r { Some(i) } else { None }, 3);
    let has_uvs = complete(|r| if let Role::Uv(i) = r { Some(i) } else { None }, 2);
    let has_colors = complete(|r| if let Role::Color(i) = r { Some(i) } else { None }, 3);
    let count = element.count as usize;
    let mesh = &mut data.mesh;
    mesh.positions.reserve(count);
    mesh.normals.reserve(if has_normals { count } else { 0 });
    mesh.uvs.reserve(if has_uvs { count } else { 0 });
    mesh.colors.reserve(if has_colors { count } else { 0 });
    let only_positions = element.properties.len() == 3
        && roles.iter().zip(0..).all(|(&(kind, role), axis)| {
            kind == Kind::Scalar(Scalar::F32) && matches!(role, Role::Position(i) if i == axis)
        });
    // sRGB decoding takes a power; bytes have few values.
    let bytes: Vec<f32> = (0..=255).map(|b| linear(f64::from(b), Scalar::U8)).collect();

    let mut row = 0;
    while row < element.count {
        if only_positions {
            row += source.plain_positions(element.count - row, &mut mesh.positions);
            if row == element.count {
                break;
            }
        }
        let (mut position, mut normal, mut uv, mut color) = ([0.0f32; 3], [0.0f32; 3], [0.0f32; 2], [0.0f32; 3]);
        let at_row = |fail| (fail, row);
        source.begin_row().map_err(at_row)?;
        for &(kind, role) in &roles {
            let scalar = match kind {
                Kind::Scalar(scalar) => scalar,
                Kind::List { count, item } => {
                    let length = source.number(count).map_err(at_row)?.max(0.0) as u64;
                    for _ in 0..length {
                        source.number(item).map_err(at_row)?;
                    }
                    continue;
                }
            };
            let value = source.number(scalar).map_err(at_row)?;
            match role {
                Role::Position(i) => position[i] = finite(value, "position", row, source, report),
                // Normals that are not finite are repaired later.
                Role::Normal(i) => normal[i] = value as f32,
                Role::Uv(i) if has_uvs => uv[i] = finite(value, "texture coordinate", row, source, report),
                Role::Color(i) if scalar == Scalar::U8 => color[i] = bytes[value.clamp(0.0, 255.0) as usize],
                Role::Color(i) => color[i] = linear(finite(value, "colour", row, source, report).into(), scalar),
                _ => {}
            }
        }
        end_row(source, report);
        mesh.positions.push(position);
        if has_normals {
            mesh.normals.push(normal);
        }
        if has_uvs {
            mesh.uvs.push(uv);
        }
        if has_colors {
            mesh.colors.push(color);
        }
        row += 1;
    }
    Ok(())
}

fn read_faces<S: Source>(
    element: &Element,
    vertices: u64,
    source: &mut S,
    report: &mut Report<'_>,
    data: &mut Data,
) -> Result<(), (Fail, u64)> {
    let list = vertex_list(element);
    let strips = element.name == "tristrips";
    let mut strip: Vec<u32> = Vec::new();
    if let (false, Some(Kind::List { count, item })) = (strips, list.map(|l| element.properties[l].kind)) {
        let faces = element.count.min(source.remaining() / (S::least_size(count) + 3 * S::least_size(item))) as usize;
        data.sizes.reserve(faces);
        data.corners.reserve(3 * faces);
    }
    let only_list = match element.properties.as_slice() {
        [Property { kind: Kind::List { count, item }, .. }] if !strips => Some((*count, *item)),
        _ => None,
    };
    let mut row = 0;
    while row < element.count {
        if let Some(list) = only_list {
            let read = source.plain_triangles(list, element.count - row, vertices, &mut data.corners);
            data.sizes.resize(data.sizes.len() + read as usize, 3);
            row += read;
            if row == element.count {
                break;
            }
        }
        let at_row = |fail| (fail, row);
        source.begin_row().map_err(at_row)?;
        for (place, property) in element.properties.iter().enumerate() {
            let (count, item) = match property.kind {
                Kind::Scalar(scalar) => {
                    source.number(scalar).map_err(at_row)?;
                    continue;
                }
                Kind::List { count, item } => (count, item),
            };
            let length = source.number(count).map_err(at_row)?;
            if !(length >= 0.0 && length.fract() == 0.0) {
                report.at(source.place(), "faces", || {
                    Diagnostic::error(format!("{length} is no count of values in a list"))
                });
                continue;
            }
            if Some(place) != list {
                for _ in 0..length as u64 {
                    source.number(item).map_err(at_row)?;
                }
                continue;
            }
            let first = data.corners.len();
            for _ in 0..length as u64 {
                let index = source.number(item).map_err(at_row)?;
                if index >= 0.0 && index < vertices as f64 && index.fract() == 0.0 {
                    if strips { strip.push(index as u32) } else { data.corners.push(index as u32) }
                } else if strips && index == -1.0 {
                    finish_strip(&mut strip, data);
                } else {
                    report.at(source.place(), "vertices that are not there", || {
                        let what = if strips { "strip" } else { "face" };
                        let message = format!("{what} {row} names vertex {index}, but there are {vertices} vertices");
                        Diagnostic::error(message).help("vertices count from 0")
                    });
                }
            }
            if strips {
                finish_strip(&mut strip, data);
            } else if length >= 3.0 {
                data.sizes.push((data.corners.len() - first) as u32);
            } else {
                data.corners.truncate(first);
                report.at(source.place(), "faces with too few vertices", || {
                    Diagnostic::warning(format!("face {row} has {length} vertices: it is left out"))
                });
            }
        }
        end_row(source, report);
        row += 1;
    }
    Ok(())
}

/// Every three neighbours of a strip are a triangle, every second one turned.
fn finish_strip(strip: &mut Vec<u32>, data: &mut Data) {
    for (i, w) in strip.windows(3).enumerate() {
        data.strips.push(if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] });
    }
    strip.clear();
}

fn end_row<S: Source>(source: &mut S, report: &mut Report<'_>) {
    if let Some(range) = source.end_row() {
        report.at(range, "lines with too many numbers", || {
            Diagnostic::warning("more on this line than the header declares: it is ignored")
        });
    }
}

fn tell(fail: Fail, element: &Element, row: u64, report: &mut Report<'_>) {
    let (name, count) = (quoted(element.name.as_bytes()), element.count);
    match fail {
        Fail::Ends(at) => report.at(at.saturating_sub(1)..at, "rows", || {
            Diagnostic::error(format!("the file ends within row {row} of {name}, of which its header promises {count}"))
        }),
        Fail::ShortRow(range) => report.at(range, "rows", || {
            Diagnostic::error(format!("row {row} of {name} has fewer numbers than the header declares"))
        }),
        Fail::NoNumber(range) => {
            let text = quoted(&report.bytes[range.clone()]);
            report.at(range, "words that are no numbers", || Diagnostic::error(format!("{text} is no number")));
        }
    }
}
