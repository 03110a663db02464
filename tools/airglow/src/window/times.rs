//! Device times of passes over the last frames, which outlive plans.

use std::collections::{BTreeMap, VecDeque};

use airglow_gpu::{FrameTimes, Timing};

use crate::scene_options::ROOMS;

/// Frames that are kept.
const FRAMES: usize = 240;
/// Frames that the time of a pass is the median of.
const RECENT: usize = 60;

/// Times of the last frames.
#[derive(Debug, Default)]
pub struct Times {
    /// Names of passes in the order in which they were first seen.
    names: Vec<String>,
    frames: VecDeque<Vec<(usize, f32)>>,
    /// The newest frame that was taken.
    newest: Option<u64>,
}

impl Times {
    /// Takes frames that are new; the passes of one room, and those of one name, count together.
    pub fn take(&mut self, timing: &Timing) {
        let names = timing.passes();
        let newest = self.newest;
        for frame in timing.frames().filter(|frame| newest.is_none_or(|newest| frame.frame > newest)) {
            self.add(names, frame);
        }
    }

    fn add(&mut self, names: &[String], frame: &FrameTimes) {
        let mut sums: BTreeMap<usize, f32> = BTreeMap::new();
        for (name, seconds) in names.iter().zip(&frame.passes) {
            let name = group(name);
            let known = self.names.iter().position(|known| known == name);
            let place = known.unwrap_or_else(|| {
                self.names.push(name.to_owned());
                self.names.len() - 1
            });
            *sums.entry(place).or_default() += 1e3 * *seconds as f32;
        }
        if self.frames.len() == FRAMES {
            self.frames.pop_front();
        }
        self.frames.push_back(sums.into_iter().collect());
        self.newest = Some(frame.frame);
    }

    /// Frames, oldest first: milliseconds of each pass by its place among [`Times::names`].
    pub fn frames(&self) -> impl DoubleEndedIterator<Item = &[(usize, f32)]> + ExactSizeIterator {
        self.frames.iter().map(Vec::as_slice)
    }

    /// Names of all passes ever seen.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Passes of the newest frame with the median of their times over the last frames, milliseconds; in the order in
    /// which they were first seen.
    pub fn medians(&self) -> Vec<(usize, f32)> {
        let Some(newest) = self.frames.back() else { return Vec::new() };
        let median = |place: usize| {
            let recent = self.frames.iter().rev().take(RECENT);
            let mut times: Vec<f32> = recent
                .filter_map(|frame| frame.iter().find(|(at, _)| *at == place))
                .map(|(_, t)| *t)
                .collect();
            times.sort_by(f32::total_cmp);
            times.get(times.len() / 2).copied().unwrap_or(0.0)
        };
        newest.iter().map(|&(place, _)| (place, median(place))).collect()
    }

    /// Milliseconds of the passes of a room in the newest frame's plan; `None` where it has none.
    pub fn of(&self, room: &str) -> Option<f32> {
        self.medians().iter().find(|(place, _)| self.names[*place] == room).map(|(_, time)| *time)
    }
}

/// The room of a pass, or its name without the number of its repetition.
fn group(name: &str) -> &str {
    let room = ROOMS.into_iter().find(|room| {
        name.strip_prefix(room).is_some_and(|rest| rest.is_empty() || rest.starts_with([' ', '#']))
    });
    room.unwrap_or_else(|| name.split('#').next().unwrap_or(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(number: u64, seconds: &[f64]) -> FrameTimes {
        FrameTimes { frame: number, passes: seconds.to_vec(), ..FrameTimes::default() }
    }

    #[test]
    fn passes_of_one_name_count_together_and_outlive_a_plan() {
        let mut times = Times::default();
        let [a, b, b2, c] = ["relight colours", "skin", "skin#2", "fog"].map(str::to_owned);
        for number in 0..3 {
            times.add(&[a.clone(), b.clone(), b2.clone()], &frame(number, &[1e-3, 2e-3, 3e-3]));
        }
        assert_eq!(times.medians(), [(0, 1.0), (1, 5.0)]);
        times.add(&[c, b], &frame(4, &[4e-3, 1e-3]));
        assert_eq!(times.medians(), [(1, 5.0), (2, 4.0)], "of the plan as it is now, over all frames");
        assert_eq!((times.of("fog"), times.of("relight")), (Some(4.0), None));
        assert_eq!(times.frames().len(), 4);
    }
}
