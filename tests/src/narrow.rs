//! Narrow vectors: llvmpipe reads its width once, so subgroups of 4 need a process of their own.

use std::env;
use std::process::Command;

/// Set in the process that [`again`] starts.
const NARROW: &str = "AIRGLOW_TEST_NARROW";

/// Runs the calling test of this program, `name` with its modules, once more with vectors of 128 bits, and returns what it
/// got as `values` there: the same where the device is no llvmpipe. `None` in that process, whose test is then done.
///
/// # Panics
/// When the process cannot be started or says no values.
pub fn again(name: &str, values: &[f32]) -> Option<Vec<f32>> {
    if env::var_os(NARROW).is_some() {
        let bits: Vec<_> = values.iter().map(|value| format!("{:08x}", value.to_bits())).collect();
        println!("bits {}", bits.join(" "));
        return None;
    }
    let program = env::current_exe().unwrap_or_else(|error| panic!("no program to run again: {error}"));
    let mut command = Command::new(program);
    command.args(["--exact", name, "--nocapture"]).env(NARROW, "1").env("LP_NATIVE_VECTOR_WIDTH", "128");
    let output = command.output().unwrap_or_else(|error| panic!("it does not run again: {error}"));
    let text = String::from_utf8_lossy(&output.stdout);
    let line = text.lines().find_map(|line| line.split_once("bits ")).map(|(_, bits)| bits);
    let line = line.unwrap_or_else(|| panic!("{text}\n{}", String::from_utf8_lossy(&output.stderr)));
    let value = |word| u32::from_str_radix(word, 16).unwrap_or_else(|error| panic!("{word}: {error}"));
    let narrow: Vec<f32> = line.split(' ').map(|word| f32::from_bits(value(word))).collect();
    let same = narrow.iter().zip(values).filter(|(a, b)| a.to_bits() == b.to_bits()).count();
    println!("{name}: {same} of {} values have the same bits in subgroups of 4", values.len());
    Some(narrow)
}
