//! One word for how exactly a room works, the same in all of them.

use std::fmt;
use std::str::FromStr;

use crate::MathError;

/// How exactly a room works. Each room turns it into its settings by `From`, as plain data that a host may change on;
/// what each costs and errs on a device is measured by `airglow report presets`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Preset {
    /// Least time and memory; errors that a still picture shows.
    Low,
    /// The defaults of all settings.
    #[default]
    Medium,
    /// Where there is time left.
    High,
    /// What others are compared with, not for frames that must be fast.
    Reference,
}

impl Preset {
    /// All, coarsest first.
    pub const ALL: [Self; 4] = [Self::Low, Self::Medium, Self::High, Self::Reference];

    /// As it is written on command lines and in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
            Self::Reference => "reference",
        }
    }

    /// Bands of spherical harmonics, 3 to 6: the same in all rooms whose vectors meet.
    #[must_use]
    pub fn order(self) -> usize {
        match self {
            Self::Low => 3,
            Self::Medium => 4,
            Self::High => 5,
            Self::Reference => 6,
        }
    }

    /// The next below; none below [`Preset::Low`].
    #[must_use]
    pub fn below(self) -> Option<Self> {
        Self::ALL.into_iter().rev().find(|preset| *preset < self)
    }
}

impl fmt::Display for Preset {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl FromStr for Preset {
    type Err = MathError;

    /// A preset by its name.
    ///
    /// # Errors
    /// [`MathError::Preset`] with all names.
    fn from_str(name: &str) -> Result<Self, MathError> {
        let named = Self::ALL.into_iter().find(|preset| preset.name() == name);
        named.ok_or_else(|| MathError::Preset { name: name.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_back_and_others_are_refused() {
        for preset in Preset::ALL {
            assert_eq!(preset.to_string().parse(), Ok(preset));
        }
        let refused = "ultra".parse::<Preset>().unwrap_err().to_string();
        assert!(refused.contains("ultra") && refused.contains("reference"), "{refused}");
    }

    #[test]
    fn the_default_is_between_the_ends() {
        assert_eq!(Preset::default().below(), Some(Preset::Low));
        assert_eq!(Preset::Low.below(), None);
        assert!(Preset::ALL.is_sorted_by_key(|preset| preset.order()));
    }
}
