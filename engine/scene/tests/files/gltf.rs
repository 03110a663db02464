//! glTF files made in memory: what is read, and what is said about what is not.

use crate::support::{Model, U8, U16, full_model, put};
use airglow_scene::{AlphaMode, ChannelValues, Encoding, LightKind, MaterialClass, Wrap};
use base64::Engine;
use glam::{Mat4, Vec3};
use serde_json::json;

fn messages(scene: &airglow_scene::Scene) -> String {
    scene.warnings.iter().map(|warning| format!("{warning}\n")).collect()
}

#[test]
fn a_square_keeps_its_vertices_and_gets_normals() {
    let scene = Model::square().load().unwrap();
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.positions[2], [1.0, 1.0, 0.0]);
    assert_eq!(mesh.indices, [0, 1, 2, 0, 2, 3]);
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 4]);
    assert_eq!((mesh.name.as_str(), mesh.triangle_count()), ("mesh", 2));
    assert_eq!(scene.materials[mesh.material].class, MaterialClass::Lambert);
    assert!(messages(&scene).contains("normals generated"), "{}", messages(&scene));
}

#[test]
fn every_feature_arrives() {
    let scene = full_model().load().unwrap();
    let material = &scene.materials[0];
    assert_eq!((material.class, material.alpha), (MaterialClass::Glossy, AlphaMode::Mask { cutoff: 0.25 }));
    assert_eq!(material.emissive, [5.0, 0.0, 0.0]);
    let color = material.base_color_texture.unwrap();
    let normal = material.normal_texture.unwrap();
    assert_eq!((color.wrap, color.nearest), ([Wrap::ClampToEdge, Wrap::Repeat], true));
    for texture in [color, normal] {
        assert_eq!(texture.transformed([0.25, 0.75]), [1.0, 0.75]);
    }
    // One picture, as colour and as data.
    let encodings = [scene.images[color.image].encoding, scene.images[normal.image].encoding];
    assert_eq!((scene.images.len(), encodings), (2, [Encoding::Srgb, Encoding::Linear]));
    let [grey, .., alpha] = scene.images[color.image].linear(0, 0).unwrap();
    assert!((grey - 0.503).abs() < 1e-3 && alpha == 1.0, "{grey} {alpha}");

    let mesh = &scene.meshes[0];
    assert_eq!((mesh.tangents.len(), mesh.uv0[0], mesh.joints[3]), (4, [0.0, 1.0], [0, 1, 0, 0]));
    assert_eq!(scene.instances[0].skin, Some(0));
    let globals: Vec<Mat4> = scene.nodes.iter().map(|node| node.global).collect();
    let joints = scene.skins[0].joint_matrices(&globals);
    // Up by 1 and, with the rotation of the knee (2 atan(0.6 / 0.8) about Z), X becomes (0.28, 0.96, 0).
    let knee = joints[1].transform_point3(Vec3::X);
    assert!(knee.distance(Vec3::new(0.28, 1.96, 0.0)) < 1e-6, "{knee}");
    let channel = &scene.animations[0].channels[0];
    assert_eq!((channel.node, channel.times.as_slice()), (2, [0.0, 0.5, 2.0].as_slice()));
    let ChannelValues::Rotation(values) = &channel.values else { panic!("{:?}", channel.values) };
    assert_eq!(values[1], [0.0, 0.0, 0.6, 0.8]);

    let LightKind::Spot { direction, intensity, outer, .. } = scene.lights[0].kind else { panic!() };
    assert_eq!((direction, intensity), ([0.0, 0.0, -1.0], [30.0, 15.0, 7.5]));
    assert_eq!(outer, std::f32::consts::FRAC_PI_4);
    assert_eq!(scene.camera().position(), Vec3::new(0.0, 0.0, 3.0));
    assert_eq!(scene.camera().direction(), Vec3::NEG_Z);
}

#[test]
fn buffers_may_be_data_or_files() {
    let model = Model::square();
    let folder = tempfile::tempdir().unwrap();
    put(&folder, "my data.bin", &model.buffer);
    let data = base64::engine::general_purpose::STANDARD.encode(&model.buffer);
    let mut hashes = vec![model.load().unwrap().meshes[0].hash];
    for uri in ["my%20data.bin".to_owned(), format!("data:application/octet-stream;base64,{data}")] {
        let mut json = model.json.clone();
        json["buffers"] = json!([{ "byteLength": model.buffer.len(), "uri": uri }]);
        let file = put(&folder, "model.gltf", &serde_json::to_vec(&json).unwrap());
        hashes.push(airglow_scene::load(&file).unwrap().meshes[0].hash);
    }
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{hashes:?}");
}

#[test]
fn strides_and_sparse_accessors_are_followed() {
    let mut model = Model::square();
    // Positions again, every 16 bytes, and the third replaced.
    let padded: Vec<f32> = (0..4).flat_map(|i| [i as f32, 1.0, 2.0, f32::NAN]).collect();
    let view = model.view(bytemuck::cast_slice(&padded[..15]));
    model.json["bufferViews"][view]["byteStride"] = json!(16);
    let indices = model.view(&[2]);
    let values = model.view(bytemuck::cast_slice(&[7.0_f32, 8.0, 9.0]));
    model.json["accessors"][0]["bufferView"] = json!(view);
    model.json["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": { "bufferView": indices, "componentType": U8 },
        "values": { "bufferView": values },
    });
    let scene = model.load().unwrap();
    let expected = [[0.0, 1.0, 2.0], [1.0, 1.0, 2.0], [7.0, 8.0, 9.0], [3.0, 1.0, 2.0]];
    assert_eq!(scene.meshes[0].positions, expected);
    model.json["accessors"][0]["sparse"]["count"] = json!(2);
    assert!(model.error().contains("do not fit"), "{}", model.error());
}

#[test]
fn what_is_not_read_is_named() {
    let mut model = Model::square();
    let colors = model.accessor(&[0_u8; 16], U8, "VEC4", 4);
    model.json["accessors"][colors]["normalized"] = json!(true);
    model.attribute("COLOR_0", colors);
    let primitive = &mut model.json["meshes"][0]["primitives"][0];
    primitive["targets"] = json!([{ "POSITION": 0 }]);
    primitive["material"] = json!(0);
    let points = json!({ "attributes": { "POSITION": 0 }, "mode": 0 });
    model.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(points);
    let sheen = json!({ "KHR_materials_sheen": {} });
    model.json["materials"] = json!([{ "alphaMode": "BLEND", "extensions": sheen }]);
    model.push("scenes", json!({ "nodes": [] }));
    let said = messages(&model.load().unwrap());
    let expected =
        ["COLOR_0", "1 morph targets", "Points left out", "KHR_materials_sheen", "blended alpha", "scene 1"];
    for expected in expected {
        assert!(said.contains(expected), "{expected:?} is not in\n{said}");
    }
}

#[test]
fn the_instance_tells_mirroring_and_uneven_scale() {
    let mut model = Model::square();
    for (scale, mirrored, uniform) in
        [([2.0, 2.0, 2.0], false, true), ([-1.0, 1.0, 1.0], true, true), ([1.0, 2.0, 1.0], false, false)]
    {
        model.json["nodes"][0]["scale"] = json!(scale);
        let instance = &model.load().unwrap().instances[0];
        assert_eq!(
            (instance.is_mirrored(), instance.is_uniformly_scaled()),
            (mirrored, uniform),
            "{scale:?}"
        );
    }
    model.json["nodes"][0]["scale"] = json!([1.0, 0.0, 1.0]);
    let scene = model.load().unwrap();
    assert!(scene.instances.is_empty() && messages(&scene).contains("flattens"), "{}", messages(&scene));
}

/// A change to the square and a part of the message it must lead to.
type Fault = (fn(&mut Model), &'static str);

#[test]
fn faults_are_refused_with_their_place() {
    let faults: [Fault; 22] = [
        (|m| m.json["meshes"][0]["primitives"][0]["indices"] = json!(9), "accessor 9 does not exist"),
        (|m| m.json["accessors"][0]["count"] = json!(5), "do not fit into buffer view 0"),
        (|m| m.json["accessors"][0]["count"] = json!(0), "it is empty"),
        (|m| m.json["accessors"][0]["count"] = json!(u64::MAX), "exceed the limit"),
        (|m| m.json["accessors"][0]["byteOffset"] = json!(u64::MAX), "do not fit"),
        (|m| m.json["accessors"][0]["type"] = json!("VEC2"), "POSITION (accessor 0): Vec2 of F32 found"),
        (|m| m.json["accessors"][1]["componentType"] = json!(5122), "indices (accessor 1): Scalar of I16"),
        (|m| m.json["bufferViews"][0]["byteOffset"] = json!(u64::MAX), "buffer view 0: bytes"),
        (|m| m.json["bufferViews"][0]["byteStride"] = json!(4), "stand every 4 bytes"),
        (|m| m.json["buffers"] = json!([{ "byteLength": 4096 }]), "buffer 0"),
        (|m| m.json["nodes"][0]["children"] = json!([0]), "node 0 \"node\": it is its own ancestor"),
        (|m| m.json["nodes"][0]["children"] = json!([7]), "its child, node 7, does not exist"),
        (|m| m.json["nodes"][0]["scale"] = json!([1e300, 1.0, 1.0]), "not finite"),
        (
            |m| m.json["nodes"][0]["scale"] = json!([1e13, 1.0, 1.0]),
            "instance \"node\": a vertex lies farther",
        ),
        (|m| m.positions(&[[3e38; 3]; 4]), "scale the scene down"),
        (|m| m.json["nodes"][0]["rotation"] = json!([0, 0, 0, 0]), "not a quaternion"),
        (|m| m.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]), "uncompressed"),
        (|m| m.json["images"] = json!([{}]), "image 0: neither"),
        (|m| m.json["images"] = json!([{ "bufferView": 0 }]), "MIME type"),
        (|m| m.json["cameras"] = json!([{ "type": "orthographic" }]), "camera 0"),
        (|m| m.buffer[48] = 9, "index 0 is 9, but there are 4 vertices"),
        (|m| m.buffer[..4].copy_from_slice(&f32::NAN.to_le_bytes()), "1 positions are NaN or infinite"),
    ];
    for (change, expected) in faults {
        let mut model = Model::square();
        change(&mut model);
        let message = model.error();
        assert!(message.contains("model.glb") && message.contains(expected), "{expected:?} not in {message}");
    }
}

#[test]
fn faults_of_skins_lights_and_animations_are_refused() {
    let faults: [Fault; 10] = [
        (|m| m.json["skins"][0]["joints"] = json!([1]), "names joint 1, but the skin has 1"),
        (|m| m.json["skins"][0]["joints"] = json!([1, 2, 3]), "2 inverse bind matrices for 3 joints"),
        (|m| m.json["animations"][0]["channels"][0]["sampler"] = json!(3), "sampler 3 does not exist"),
        (|m| m.json["animations"][0]["channels"][0]["target"]["node"] = json!(9), "node 9 does not exist"),
        (|m| m.json["animations"][0]["channels"][0]["target"]["path"] = json!("x"), "its path is none of"),
        (|m| m.json["animations"][0]["samplers"][0]["interpolation"] = json!("CUBICSPLINE"), "9 expected"),
        (|m| m.json["animations"][0]["samplers"][0]["input"] = json!(1), "input"),
        (|m| m.json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = json!(-1.0), "strength"),
        (|m| m.json["cameras"][0]["perspective"]["znear"] = json!(-1.0), "camera 0"),
        (|m| m.json["materials"][0]["emissiveFactor"] = json!([1e300, 0, 0]), "material 0 \"board\""),
    ];
    for (change, expected) in faults {
        let mut model = full_model();
        change(&mut model);
        let message = model.error();
        assert!(message.contains(expected), "{expected:?} not in {message}");
    }
}

#[test]
fn deep_hierarchies_are_refused_and_not_recursed() {
    let mut model = Model::square();
    let count = 100_000;
    let chain = (0..count).map(|index| match index + 1 < count {
        true => json!({ "children": [index + 1] }),
        false => json!({ "mesh": 0 }),
    });
    model.json["nodes"] = chain.collect();
    assert!(model.error().contains("exceed the limit of 1024"), "{}", model.error());
}

#[test]
fn normalized_texture_coordinates_and_byte_indices_are_read() {
    let mut model = Model::square();
    let uv = model.accessor(&[0_u16, 65535, 65535, 65535, 65535, 0, 0, 0], U16, "VEC2", 4);
    model.json["accessors"][uv]["normalized"] = json!(true);
    model.attribute("TEXCOORD_0", uv);
    let indices = model.accessor(&[0_u8, 1, 2], U8, "SCALAR", 3);
    model.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    let scene = model.load().unwrap();
    assert_eq!(scene.meshes[0].uv0[1], [1.0, 1.0]);
    assert_eq!(scene.meshes[0].indices, [0, 1, 2]);
}
