//! Compiles the lookups of the shapes in the folder `STUDENT_T_HEADERS`, as C and as C++.

use std::fmt::Write;
use std::path::PathBuf;
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-env-changed=STUDENT_T_HEADERS");
    println!("cargo::rerun-if-changed=src");
    let folder =
        PathBuf::from(env::var_os("STUDENT_T_HEADERS").expect("STUDENT_T_HEADERS: a folder"));
    println!("cargo::rerun-if-changed={}", folder.display());
    let out = PathBuf::from(env::var_os("OUT_DIR").unwrap());

    let mut names: Vec<String> = fs::read_dir(&folder)
        .expect("the folder of the headers")
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter_map(|name| Some(name.strip_prefix("student_t_gamma_")?.strip_suffix(".h")?.into()))
        .collect();
    names.sort();
    assert!(!names.is_empty(), "no shapes in {}", folder.display());
    let mut header = String::new();
    for name in &names {
        writeln!(header, "#include \"student_t_gamma_{name}.h\"").unwrap();
    }
    header.push_str("#define SHAPES {");
    for name in &names {
        write!(header, "&student_t_gamma_{name}, ").unwrap();
    }
    fs::write(out.join("shapes.h"), header + "}\n").unwrap();
    let gammas: Vec<String> = names.iter().map(|name| name.replace('p', ".")).collect();
    fs::write(out.join("gammas.txt"), gammas.join("\n")).unwrap();

    // The tables of dielectrics.
    let mut indices: Vec<String> = fs::read_dir(&folder)
        .expect("the folder of the headers")
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter_map(|name| Some(name.strip_prefix("student_t_eta_")?.strip_suffix(".h")?.into()))
        .collect();
    indices.sort();
    assert!(!indices.is_empty(), "no dielectrics in {}", folder.display());
    let includes: String =
        indices.iter().map(|name| format!("#include \"student_t_eta_{name}.h\"\n")).collect();
    let all: String = indices.iter().map(|name| format!("&student_t_eta_{name}, ")).collect();
    fs::write(out.join("indices.h"), format!("{includes}#define INDICES {{{all}}}\n")).unwrap();
    let etas: Vec<String> = indices.iter().map(|name| name.replace('p', ".")).collect();
    fs::write(out.join("indices.txt"), etas.join("\n")).unwrap();

    // Optimised, without relaxed arithmetic, every warning an error.
    for (cpp, standard, prefix) in [(false, "c99", "c_"), (true, "c++11", "cpp_")] {
        let mut build = cc::Build::new();
        build.cpp(cpp).opt_level(2).std(standard).warnings_into_errors(true).extra_warnings(true);
        build.flag_if_supported("-Wpedantic").flag_if_supported("-Wconversion");
        if cpp {
            // One file is compiled as C and as C++; GCC and Clang would take the language from its
            // name.
            build.flag("-xc++");
        }
        build.define("PREFIX", prefix).includes([&folder, &out]);
        build.files(
            ["lookups", "families", "interfaces", "materials", "pictures"]
                .map(|name| format!("src/{name}.c")),
        );
        build.compile(&format!("{prefix}lookups"));
    }
}
