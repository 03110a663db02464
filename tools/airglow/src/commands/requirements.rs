//! `airglow requirements`: what a device must offer, before there is one.

use airglow_gpu::Requirements;
use airglow_gpu::ash::vk;
use clap::{Args, ValueEnum};

use crate::failure::Outcome;
use crate::output::{Output, print};

/// Print what a device must offer for rooms of the library with their default settings: version, extensions, features,
/// limits and formats, each with what it is for. No device is opened.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  airglow requirements                 of every room, joined
  airglow requirements engine          of the device layer alone
  airglow --json requirements          for a host in another language")]
pub struct Arguments {
    /// The rooms; without any, all of them.
    #[arg(value_enum, value_name = "ROOM")]
    rooms: Vec<Room>,
}

/// Who requires something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Room {
    /// The device layer under all rooms.
    Engine,
    /// Relighting by precomputed radiance transfer.
    #[cfg(feature = "relight")]
    Relight,
    /// Scattering in a medium.
    #[cfg(feature = "fog")]
    Fog,
}

impl Room {
    fn requirements(self) -> Requirements {
        match self {
            Self::Engine => Requirements::engine(),
            #[cfg(feature = "relight")]
            Self::Relight => airglow::relight::Relight::requirements(&Default::default()),
            #[cfg(feature = "fog")]
            Self::Fog => airglow::fog::Fog::requirements(&Default::default()),
        }
    }
}

/// Runs the command.
pub fn run(arguments: &Arguments, output: &Output) -> Outcome {
    let rooms = match arguments.rooms.is_empty() {
        true => Room::value_variants(),
        false => &arguments.rooms[..],
    };
    let requirements = rooms.iter().fold(Requirements::engine(), |all, room| all.and(&room.requirements()));
    print(&if output.json() { requirements.json() } else { text(&requirements) })
}

/// One requirement a line.
fn text(all: &Requirements) -> String {
    let word = |required: bool| if required { "required" } else { "optional" };
    let version = all.api_version;
    let (major, minor) = (vk::api_version_major(version), vk::api_version_minor(version));
    let mut lines = vec![format!("Vulkan {major}.{minor}, a queue family with {:?}", all.queue)];
    let instance = all.instance_extensions.iter();
    lines
        .extend(instance.map(|e| format!("instance extension {}: {}, {}", e.name, word(e.required), e.buys)));
    lines.extend(all.extensions.iter().map(|name| format!("device extension {name}: required")));
    let optional = all.optional_extensions.iter();
    lines.extend(optional.map(|e| format!("device extension {}: {}, {}", e.name, word(e.required), e.buys)));
    for need in &all.features {
        let before = match need.feature.extension_before_1_3() {
            Some(extension) => format!(" (below Vulkan 1.3 with {extension})"),
            None => String::new(),
        };
        let (name, required) = (need.feature.name(), word(need.required));
        lines.push(format!("feature {name}: {required}, {}{before}", need.buys));
    }
    lines.extend(all.limits.iter().map(|n| format!("limit {} >= {}: {}", n.limit.name(), n.at_least, n.why)));
    lines.extend(all.formats.iter().map(|n| format!("format {:?} as {:?}: {}", n.format, n.usage, n.why)));
    lines.join("\n")
}
