//! What every command is told: its device, its checks, and how it speaks.

use clap::Args;

/// Options that every command understands, in help below those of its own.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Global options")]
pub struct Global {
    /// Vulkan device: its index in `airglow devices`, part of its name, or a kind (discrete, integrated,
    /// virtual, cpu). Without it the fastest kind present is taken.
    #[arg(long, global = true, value_name = "DEVICE")]
    pub device: Option<String>,
    /// Switch on the Vulkan validation layers with synchronization checks; any message fails the command.
    #[arg(long, global = true)]
    pub validate: bool,
    /// Print results only: no progress bars, no remarks.
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// Print results as JSON on standard output.
    #[arg(long, global = true)]
    pub json: bool,
}
