//! Vertex attributes and indices out of buffers. Nothing is read before it is known to lie inside
//! its buffer. Errors are texts that the caller puts in context.

use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::View;
use gltf::{Accessor, Primitive, Semantic};

use super::data::Data;

/// Most elements in one accessor: a sparse one takes no room in the file, so it needs a bound.
const MAX_COUNT: usize = 1 << 24;

/// Vertex positions in the mesh's own space.
pub(super) fn positions(primitive: &Primitive<'_>, data: &Data) -> Result<Vec<[f32; 3]>, String> {
    let Some(accessor) = primitive.get(&Semantic::Positions) else {
        return Err("no positions".to_owned());
    };
    check(
        &accessor,
        data,
        &[DataType::F32],
        Dimensions::Vec3,
        "positions",
    )?;
    let reader = primitive.reader(|buffer| data.buffer(buffer.index()));
    let positions = reader.read_positions();
    Ok(positions.ok_or("positions cannot be read")?.collect())
}

/// Texture coordinates of one set, v down as the core has it; `None` if the mesh has none.
pub(super) fn tex_coords(
    primitive: &Primitive<'_>,
    set: u32,
    data: &Data,
) -> Result<Option<Vec<[f32; 2]>>, String> {
    let Some(accessor) = primitive.get(&Semantic::TexCoords(set)) else {
        return Ok(None);
    };
    let types = [DataType::F32, DataType::U8, DataType::U16];
    check(
        &accessor,
        data,
        &types,
        Dimensions::Vec2,
        "texture coordinates",
    )?;
    let reader = primitive.reader(|buffer| data.buffer(buffer.index()));
    let coordinates = reader.read_tex_coords(set);
    let coordinates = coordinates.ok_or("texture coordinates cannot be read")?;
    Ok(Some(coordinates.into_f32().collect()))
}

/// The indices, all below `vertices`; counted up where the mesh has none.
pub(super) fn indices(
    primitive: &Primitive<'_>,
    vertices: usize,
    data: &Data,
) -> Result<Vec<u32>, String> {
    let Some(accessor) = primitive.indices() else {
        return Ok((0..vertices as u32).collect());
    };
    let types = [DataType::U8, DataType::U16, DataType::U32];
    check(&accessor, data, &types, Dimensions::Scalar, "indices")?;
    let reader = primitive.reader(|buffer| data.buffer(buffer.index()));
    let indices = reader.read_indices().ok_or("indices cannot be read")?;
    let indices: Vec<u32> = indices.into_u32().collect();
    match indices.iter().find(|&&index| index as usize >= vertices) {
        Some(index) => Err(format!(
            "an index names vertex {index}, but there are {vertices}"
        )),
        None => Ok(indices),
    }
}

/// That an accessor has a type that the crate's readers know and lies inside its buffers.
fn check(
    accessor: &Accessor<'_>,
    data: &Data,
    types: &[DataType],
    dimensions: Dimensions,
    what: &str,
) -> Result<(), String> {
    if !types.contains(&accessor.data_type()) || accessor.dimensions() != dimensions {
        return Err(format!(
            "{what} of type {:?} {:?} are not supported",
            accessor.dimensions(),
            accessor.data_type()
        ));
    }
    let count = accessor.count();
    if count == 0 || count > MAX_COUNT {
        return Err(format!(
            "{count} {what}, where 1 to {MAX_COUNT} are supported"
        ));
    }
    let outside = || format!("{what} reach beyond their buffer");
    let size = accessor.size();
    if let Some(view) = accessor.view()
        && !inside(&view, accessor.offset(), count, size, data)
    {
        return Err(outside());
    }
    if let Some(sparse) = accessor.sparse() {
        let (indices, values) = (sparse.indices(), sparse.values());
        let index_size = indices.index_type().size();
        let count = sparse.count();
        if count == 0
            || count > accessor.count()
            || !inside(&indices.view(), indices.offset(), count, index_size, data)
            || !inside(&values.view(), values.offset(), count, size, data)
        {
            return Err(outside());
        }
    }
    Ok(())
}

/// Whether `count` elements of `size` bytes lie inside the view and the view inside its buffer.
fn inside(view: &View<'_>, offset: usize, count: usize, size: usize, data: &Data) -> bool {
    let stride = view.stride().unwrap_or(size);
    let end = (count - 1)
        .checked_mul(stride)
        .and_then(|last| last.checked_add(offset)?.checked_add(size));
    stride >= size && end.is_some_and(|end| end <= view.length()) && data.view(view).is_some()
}
