//! Skins and animations: read and checked.

use std::path::Path;

use glam::Mat4;
use gltf::accessor::{DataType, Dimensions};
use gltf::animation::Property;
use gltf::animation::util::ReadOutputs;

use super::accessor::{Use, check_use};
use super::document::Document;
use super::{label, name_of};
use crate::animation::{Animation, Channel, ChannelValues, Interpolation, Skin};
use crate::error::{SceneError, invalid};
use crate::scene::Scene;
use crate::warning::Warnings;

const FLOAT: &[DataType] = &[DataType::F32];
const ROTATION: &[DataType] = &[DataType::F32, DataType::I8, DataType::U8, DataType::I16, DataType::U16];

/// Reads every skin and animation.
pub(super) fn read(
    document: &Document,
    scene: &mut Scene,
    warnings: &mut Warnings<'_>,
) -> Result<(), SceneError> {
    for skin in document.gltf.skins() {
        scene.skins.push(read_skin(document, &skin, warnings.file)?);
    }
    for animation in document.gltf.animations() {
        let item = label("animation", animation.index(), animation.name());
        let mut channels = Vec::new();
        for channel in animation.channels() {
            let item = format!("{item}, channel {}", channel.index());
            if channel.target().property() == Property::MorphTargetWeights {
                warnings.add(item, "left out: it moves morph targets, which are not supported");
                continue;
            }
            channels.push(read_channel(document, &item, &channel, warnings.file)?);
        }
        let name = name_of("animation", animation.index(), animation.name());
        scene.animations.push(Animation { name, channels });
    }
    Ok(())
}

fn read_skin(document: &Document, skin: &gltf::Skin<'_>, file: &Path) -> Result<Skin, SceneError> {
    let item = label("skin", skin.index(), skin.name());
    let joints: Vec<usize> = skin.joints().map(|joint| joint.index()).collect();
    let name = name_of("skin", skin.index(), skin.name());
    let Some(accessor) = skin.inverse_bind_matrices() else {
        let inverse_bind = vec![Mat4::IDENTITY; joints.len()];
        return Ok(Skin { name, joints, inverse_bind });
    };
    let wanted = Use { name: "inverseBindMatrices", dimensions: Dimensions::Mat4, types: FLOAT };
    check_use(file, &item, &accessor, &wanted, None)?;
    if accessor.count() < joints.len() {
        let problem = format!("{} inverse bind matrices for {} joints", accessor.count(), joints.len());
        return Err(invalid(file, item, problem, "bind the skin again and export"));
    }
    let reader = skin.reader(|buffer| document.bytes(buffer));
    let matrices = reader.read_inverse_bind_matrices().into_iter().flatten().take(joints.len());
    let inverse_bind: Vec<Mat4> = matrices.map(|matrix| Mat4::from_cols_array_2d(&matrix)).collect();
    if let Some(joint) = inverse_bind.iter().position(|matrix| !matrix.is_finite()) {
        let problem = format!("the inverse bind matrix of joint {joint} is not finite");
        return Err(invalid(file, item, problem, "bind the skin again and export"));
    }
    Ok(Skin { name, joints, inverse_bind })
}

fn read_channel(
    document: &Document,
    item: &str,
    channel: &gltf::animation::Channel<'_>,
    file: &Path,
) -> Result<Channel, SceneError> {
    let broken = |problem: &str| Err(invalid(file, item, problem, "export the animation again"));
    let sampler = channel.sampler();
    let interpolation = match sampler.interpolation() {
        gltf::animation::Interpolation::Linear => Interpolation::Linear,
        gltf::animation::Interpolation::Step => Interpolation::Step,
        gltf::animation::Interpolation::CubicSpline => Interpolation::CubicSpline,
    };
    let input = Use { name: "input", dimensions: Dimensions::Scalar, types: FLOAT };
    check_use(file, item, &sampler.input(), &input, None)?;
    let values_per_time = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let (dimensions, types) = match channel.target().property() {
        Property::Rotation => (Dimensions::Vec4, ROTATION),
        _ => (Dimensions::Vec3, FLOAT),
    };
    let output = Use { name: "output", dimensions, types };
    check_use(file, item, &sampler.output(), &output, Some(values_per_time * sampler.input().count()))?;
    let reader = channel.reader(|buffer| document.bytes(buffer));
    let times: Vec<f32> = reader.read_inputs().into_iter().flatten().collect();
    let grows = times.windows(2).all(|pair| pair[0] < pair[1]);
    if !grows || !times.iter().all(|time| *time >= 0.0 && time.is_finite()) {
        return broken("its times do not grow strictly from 0 or later");
    }
    let values = match reader.read_outputs() {
        Some(ReadOutputs::Translations(values)) => ChannelValues::Translation(values.collect()),
        Some(ReadOutputs::Rotations(values)) => ChannelValues::Rotation(values.into_f32().collect()),
        Some(ReadOutputs::Scales(values)) => ChannelValues::Scale(values.collect()),
        _ => return broken("its values could not be read"),
    };
    let finite = match &values {
        ChannelValues::Translation(values) | ChannelValues::Scale(values) => {
            values.as_flattened().iter().all(|value| value.is_finite())
        }
        ChannelValues::Rotation(values) => values.as_flattened().iter().all(|value| value.is_finite()),
    };
    if !finite {
        return broken("a value is NaN or infinite");
    }
    Ok(Channel { node: channel.target().node().index(), interpolation, times, values })
}
