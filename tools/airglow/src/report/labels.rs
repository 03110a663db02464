//! Places for the names of points, so that no name covers a point or another name.

/// Pixels of a letter of a plot's labels: an estimate on the safe side.
const LETTER: (i32, i32) = (8, 14);

/// What is taken already.
pub struct Labels {
    size: (i32, i32),
    /// Left, top, right, bottom.
    taken: Vec<[i32; 4]>,
}

impl Labels {
    /// A plot of `size` pixels with these points in it.
    pub fn new(size: (u32, u32), points: impl Iterator<Item = (i32, i32)>) -> Self {
        let taken = points.map(|(x, y)| [x - 6, y - 6, x + 6, y + 6]).collect();
        Self { size: (size.0 as i32, size.1 as i32), taken }
    }

    /// Where the text of a point goes, relative to the point: the first free place around it, else to its upper right.
    pub fn place(&mut self, (x, y): (i32, i32), text: &str) -> (i32, i32) {
        let (width, height) = (LETTER.0 * text.chars().count() as i32, LETTER.1);
        let (right, left, above, below) = (10, -10 - width, -8 - height, 10);
        let places = [(right, above), (right, below), (left, above), (left, below), (-width / 2, 2 * above)];
        let boxed = |(dx, dy): (i32, i32)| [x + dx, y + dy, x + dx + width, y + dy + height];
        let free = |place: &(i32, i32)| {
            let [l, t, r, b] = boxed(*place);
            let inside = l >= 0 && t >= 0 && r <= self.size.0 && b <= self.size.1;
            inside && self.taken.iter().all(|o| r <= o[0] || o[2] <= l || b <= o[1] || o[3] <= t)
        };
        let place = places.into_iter().find(free).unwrap_or(places[0]);
        self.taken.push(boxed(place));
        place
    }
}

#[cfg(test)]
mod tests {
    use super::Labels;

    #[test]
    fn neighbours_get_different_places_and_borders_are_kept() {
        let points = [(50, 50), (70, 50), (195, 50)];
        let mut labels = Labels::new((200, 100), points.into_iter());
        let places = points.map(|point| labels.place(point, "name"));
        assert_ne!(places[0].1, places[1].1, "{places:?}");
        assert!(places[2].0 < 0, "{places:?}");
    }
}
