//! What the shared presets of each room take on a device: measured, and as it was kept.

pub mod table;

use airglow::math::Preset;

use super::model::Choice;

/// The preset that holds where nobody asks for another.
pub fn choice() -> Choice {
    Choice { setting: Preset::default().to_string(), reason: "it is the default of all settings".to_owned() }
}

#[cfg(test)]
#[cfg(all(
    feature = "fog",
    feature = "normals",
    feature = "radiance",
    feature = "relight",
    feature = "shadow"
))]
mod tests {
    use super::*;
    use airglow::{fog, normals, radiance, relight, shadow};

    #[test]
    fn medium_is_the_default_of_every_room_and_every_preset_is_accepted() {
        assert_eq!(relight::Settings::from(Preset::Medium), relight::Settings::default());
        assert_eq!(fog::Settings::from(Preset::Medium), fog::Settings::default());
        assert_eq!(radiance::PassSettings::from(Preset::Medium), radiance::PassSettings::default());
        assert_eq!(normals::Settings::from(Preset::Medium), normals::Settings::default());
        assert_eq!(shadow::Settings::from(Preset::Medium), shadow::Settings::default());
        for preset in Preset::ALL {
            relight::Settings::from(preset).check().unwrap();
            fog::Settings::from(preset).check().unwrap();
            radiance::PassSettings::from(preset).check().unwrap();
            normals::Settings::from(preset).check().unwrap();
            shadow::Settings::from(preset).check().unwrap();
        }
    }

    #[test]
    fn vectors_that_meet_have_as_many_bands() {
        for preset in Preset::ALL {
            let quality = airglow_scene::Quality::from(preset);
            let orders = [
                relight::Settings::from(preset).order,
                radiance::PassSettings::from(preset).order,
                shadow::Settings::from(preset).order,
                quality.order as usize,
            ];
            assert_eq!(orders, [preset.order(); 4]);
            let half = relight::Settings::from(preset).storage == relight::Storage::F16;
            assert_eq!(half, quality.storage == airglow_scene::Storage::F16, "{preset}");
        }
    }
}
