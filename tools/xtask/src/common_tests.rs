//! Each file of `shaders/glsl/common` compiles by itself: a host may copy one, with what it includes.

use std::path::Path;

use glslang::ShaderStage;

/// What a file asks its includer to define, as its first comment says.
fn prelude(name: &str) -> &'static str {
    match name {
        "sh_rotation" => "shared float matrices[286];\n#define SH_ROTATION(i) matrices[i]\n",
        "sh_product" => {
            "float f[36];\nfloat g[36];\nuint first[37];\nuint pairs[8];\nfloat gammas[8];\n\
             #define SH_TENSOR_FIRST(i) first[i]\n#define SH_TENSOR_PAIR(at) pairs[at]\n\
             #define SH_TENSOR_GAMMA(at) gammas[at]\n#define SH_LEFT(j) f[j]\n#define SH_RIGHT(k) g[k]\n"
        }
        _ => "",
    }
}

fn compile(name: &str, prelude: &str, order: u32) -> Result<Vec<u32>, String> {
    let text = format!(
        "#version 460\n#extension GL_GOOGLE_include_directive : require\n{prelude}\
         #include \"common/{name}.glsl\"\nlayout(local_size_x = 64) in;\nvoid main() {{}}\n"
    );
    let defines = [("ORDER".to_owned(), order.to_string())];
    let file = Path::new("common").join(name);
    crate::compile::source(&crate::shader_root(), &file, &text, ShaderStage::Compute, &defines)
}

#[test]
fn each_common_file_compiles_alone_at_every_order() {
    let folder = crate::shader_root().join("common");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        for order in 1..=6 {
            if let Err(log) = compile(&name, prelude(&name), order) {
                panic!("order {order}:\n{log}");
            }
        }
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(
            !text.contains("layout("),
            "common/{name}.glsl holds a binding; common is functions over values"
        );
        count += 1;
    }
    assert!(count > 0, "no file in common");
}

#[test]
fn a_missing_definition_is_named() {
    for (name, missing) in [("sh_rotation", "SH_ROTATION"), ("sh_product", "SH_TENSOR_FIRST")] {
        let log = compile(name, "", 4).unwrap_err();
        assert!(log.contains(missing) && log.contains(&format!("common/{name}.glsl:")), "{log}");
    }
    assert!(compile("sh_basis", "", 7).unwrap_err().contains("define ORDER"));
}
