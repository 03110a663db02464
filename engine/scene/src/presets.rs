//! How exactly a scene asks each room of the library to work.

use std::collections::BTreeMap;

use airglow_math::Preset;

use crate::settings::{Quality, Storage};

/// The room whose preset says what light transport is computed with.
pub const LIGHT_TRANSPORT: &str = "relight";

/// What a scene file says of presets: one for all rooms, and others for some by name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Presets {
    /// For every room that is not named.
    pub all: Option<Preset>,
    /// By the name of the room.
    pub rooms: BTreeMap<String, Preset>,
}

impl Presets {
    /// What is asked of a room; none where nothing is said, and its defaults hold.
    pub fn of(&self, room: &str) -> Option<Preset> {
        self.rooms.get(room).copied().or(self.all)
    }
}

impl From<Preset> for Quality {
    /// Bands of the preset, rays whose noise stays below what those bands lose, and half floats where that is little.
    fn from(preset: Preset) -> Self {
        let medium = Self { order: preset.order() as u32, ..Self::default() };
        match preset {
            Preset::Low => Self { rays: 256, storage: Storage::F16, ..medium },
            Preset::Medium => medium,
            Preset::High => Self { rays: 2048, ..medium },
            Preset::Reference => Self { rays: 4096, ..medium },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_named_room_goes_before_all() {
        let rooms = BTreeMap::from([("fog".to_owned(), Preset::High)]);
        let presets = Presets { all: Some(Preset::Low), rooms };
        assert_eq!((presets.of("fog"), presets.of("shadow")), (Some(Preset::High), Some(Preset::Low)));
        assert_eq!(Presets::default().of("fog"), None);
    }

    #[test]
    fn medium_is_the_default() {
        assert_eq!(Quality::from(Preset::Medium), Quality::default());
    }
}
