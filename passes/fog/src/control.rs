//! The view of a plan that is recorded again.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use airglow_graph::LeftOut;

use crate::FogError;
use crate::error::check;
use crate::pack::{FrameConstants, Packed, pack};
use crate::settings::Settings;
use crate::tiles::Tiles;
use crate::view::View;

/// Pixels along a side of a picture, at most.
const MAX_SIDE: u32 = 1 << 16;

/// The view of a declared frame, to be changed before its plan is recorded again. Clones are the same one.
#[derive(Clone, Debug)]
pub struct Control {
    settings: Settings,
    size: [u32; 2],
    frame: Arc<Mutex<State>>,
}

/// Lights of a view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Those whose airlight passes the bound somewhere in the picture.
    pub evaluated: u32,
    /// Those left out: dark, too weak, or out of reach of every pixel.
    pub left_out: u32,
    /// Pairs of a tile, [`TILE`](crate::TILE) pixels on a side, and a light that is evaluated in it.
    pub pairs: u32,
    /// Pairs left out: with those evaluated, as many as there are tiles times lights.
    pub pairs_left_out: u32,
}

/// What a recording takes.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub constants: FrameConstants,
    pub tiles: Tiles,
    counts: Counts,
}

impl Control {
    pub(crate) fn new(settings: Settings, size: [u32; 2], view: &View) -> Result<Self, FogError> {
        for side in size {
            let sound = (1..=MAX_SIDE).contains(&side);
            check(|| "frame.size".to_owned(), f64::from(side), sound, "a side of 1 to 65536 pixels")?;
        }
        let packed = pack(&settings, view, size)?;
        let mut state =
            State { constants: packed.constants, tiles: Tiles::new(size), counts: Counts::default() };
        state.set(&packed, view);
        Ok(Self { settings, size, frame: Arc::new(Mutex::new(state)) })
    }

    /// Sets the view that counts from the next recording on. On an error the old one stays.
    ///
    /// # Errors
    /// [`FogError::Range`] and [`FogError::TooManyLights`] for what no frame takes; [`FogError::Plan`] for a medium with
    /// no extinction, whose plan is another.
    pub fn set(&self, view: &View) -> Result<Counts, FogError> {
        if view.medium.is_clear() {
            return Err(FogError::Plan { what: "the medium is clear" });
        }
        let packed = pack(&self.settings, view, self.size)?;
        Ok(self.lock().set(&packed, view))
    }

    /// Which lights of the view set last the shader is given.
    #[must_use]
    pub fn counts(&self) -> Counts {
        self.lock().counts
    }

    /// The record of the lights that the view set last does without; `None` without such. No part of a plan, which stays
    /// while lights come and go.
    #[must_use]
    pub fn left_out(&self) -> Option<LeftOut> {
        let Counts { evaluated, left_out, pairs, pairs_left_out } = self.counts();
        (pairs_left_out > 0).then(|| LeftOut {
            what: format!(
                "fog of {left_out} of {} lights, in {pairs_left_out} of {} pairs of a tile and a light",
                evaluated + left_out,
                pairs + pairs_left_out
            ),
            why: format!(
                "no pixel there can get {} W/sr/m2 of airlight, pre-exposed, from them",
                self.settings.bound
            ),
            bytes: 0,
            time: None,
            would_return: "a stronger or nearer light, or a smaller Settings::bound".to_owned(),
        })
    }

    /// The constants of `fog/frame.glsl`: for a host's forward shader that draws the complete model by `fog/view.glsl`.
    #[must_use]
    pub fn constants(&self) -> FrameConstants {
        self.lock().constants
    }

    pub(crate) fn lock(&self) -> MutexGuard<'_, State> {
        self.frame.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// Takes a view over, without memory of its own.
    fn set(&mut self, packed: &Packed, view: &View) -> Counts {
        self.constants = packed.constants;
        self.tiles.fill(&packed.rays, view.world.depth.orthographic, &packed.regions);
        let [pairs, all] = self.tiles.pairs(packed.lights);
        let evaluated = self.tiles.present();
        let left_out = packed.lights - evaluated;
        self.counts = Counts { evaluated, left_out, pairs, pairs_left_out: all - pairs };
        self.counts
    }
}
