//! The machine that something was measured on, as reports and statistics name it.

use airglow_gpu::open::{DeviceKind, DeviceLine};
use serde::{Deserialize, Serialize};

/// The device and its driver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Device name as the driver states it.
    pub device: String,
    /// discrete, integrated, virtual, cpu or other.
    pub kind: String,
    /// Driver name and version.
    pub driver: String,
    /// Clocks, where the system says.
    pub clocks: Option<String>,
    /// Whether the driver computes on the CPU, so that the order of rivals may differ on a GPU.
    pub software: bool,
}

impl Machine {
    /// Of a device line.
    pub fn new(line: &DeviceLine) -> Self {
        Self {
            device: line.name.clone(),
            kind: kind_name(line.kind).to_owned(),
            driver: line.driver.clone(),
            clocks: clocks(line.kind),
            software: line.kind == DeviceKind::Cpu,
        }
    }
}

/// The kind in the words that `--device` takes.
pub fn kind_name(kind: DeviceKind) -> &'static str {
    match kind {
        DeviceKind::Discrete => "discrete",
        DeviceKind::Integrated => "integrated",
        DeviceKind::Virtual => "virtual",
        DeviceKind::Cpu => "cpu",
        DeviceKind::Other => "other",
    }
}

/// Clocks of a software device, from the kernel's list of processors; other drivers do not tell.
fn clocks(kind: DeviceKind) -> Option<String> {
    if kind == DeviceKind::Cpu { processor() } else { None }
}

/// Count, model and clock of the machine's processors, where the kernel lists them.
pub fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let field = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(name))?;
        line.split_once(':').map(|(_, value)| value.trim().to_owned())
    };
    let count = text.lines().filter(|line| line.starts_with("processor")).count();
    let mhz: f64 = field("cpu MHz")?.parse().ok()?;
    Some(format!("{count} x {}, {mhz:.0} MHz", field("model name")?))
}
