//! Frames on a time line, in the Trace Event Format that Perfetto and chrome://tracing open: a lane for the CPU that
//! records, a lane for the device that works, and an arrow from each pass recorded to the same pass done.
//!
//! Format: *Trace Event Format*, Google, 2016. Times are microseconds from the first pass recorded.

use airglow_gpu::{Calibration, Context, FrameTimes};
use serde_json::{Value, json};
use std::time::Instant;

use crate::host::machine::Machine;
use crate::host::work::PassWork;

/// The lanes: thread numbers of one process.
const CPU: u32 = 1;
const DEVICE: u32 = 2;

/// What a trace is made of.
pub struct Trace<'a> {
    /// Where the frames were drawn.
    pub machine: Machine,
    /// The passes of each frame.
    pub passes: &'a [PassWork],
    /// The frames, oldest first.
    pub frames: &'a [FrameTimes],
    /// Seconds from one raw value of the device's clock to another.
    pub seconds: &'a dyn Fn(u64, u64) -> f64,
    /// Both clocks before and after the frames, where the device tells.
    pub calibrations: Option<[Calibration; 2]>,
}

/// How the device's clock stands to the CPU's.
struct Alignment {
    /// A moment of the device's clock, and the same moment in seconds of the time line.
    ticks: u64,
    at: f64,
    /// Seconds of the CPU in a second of the device.
    rate: f64,
    /// For readers of the trace.
    description: String,
}

/// Seconds between calibrations below which clocks are taken to run alike: the uncertainty of both would show.
const SHORTEST_DRIFT: f64 = 0.05;

impl Alignment {
    fn new(trace: &Trace<'_>, zero: Instant) -> Self {
        let on_line =
            |at: Instant| at.duration_since(zero).as_secs_f64() - zero.duration_since(at).as_secs_f64();
        if let Some([before, after]) = trace.calibrations {
            let device = (trace.seconds)(before.ticks, after.ticks);
            let cpu = on_line(after.at) - on_line(before.at);
            let rate = if device > SHORTEST_DRIFT { cpu / device } else { 1.0 };
            let most = before.uncertainty.max(after.uncertainty).as_secs_f64();
            let description = format!("calibrated; uncertain by {:.3} us", 1e6 * most);
            return Self { ticks: before.ticks, at: on_line(before.at), rate, description };
        }
        // The least shift for which no frame begins on the device before the CPU had it recorded.
        let ticks = trace.frames.first().map_or(0, |frame| frame.start);
        let shift = |frame: &FrameTimes| {
            Some(on_line(frame.recorded.last()?[1]) - (trace.seconds)(ticks, frame.start))
        };
        let at = trace.frames.iter().filter_map(shift).fold(0.0, f64::max);
        let description = "aligned at submission: the device's clock is not calibrated, and its lane is as early as no \
                           frame that begins before it was recorded allows";
        Self { ticks, at, rate: 1.0, description: description.to_owned() }
    }
}

/// A pass or frame on a lane, in seconds.
struct Span {
    lane: u32,
    begin: f64,
    end: f64,
}

impl Span {
    fn event(&self, name: &str, arguments: Value) -> Value {
        let (begin, length) = (1e6 * self.begin, 1e6 * (self.end - self.begin).max(0.0));
        json!({ "ph": "X", "pid": 1, "tid": self.lane, "name": name, "ts": begin, "dur": length, "args": arguments })
    }

    /// One end of an arrow between lanes, bound to the pass that begins there.
    fn arrow(&self, phase: &str, id: usize) -> Value {
        let mut event = json!({ "ph": phase, "pid": 1, "tid": self.lane, "name": "recorded", "cat": "pass", "id": id, "ts": 1e6 * self.begin });
        if phase == "f" {
            event["bp"] = "e".into();
        }
        event
    }
}

impl<'a> Trace<'a> {
    /// A trace of frames drawn on `context`.
    pub fn json(&self) -> Value {
        let first =
            self.frames.iter().filter_map(|frame| frame.recorded.first()).map(|[begin, _]| *begin).min();
        let zero = first.unwrap_or_else(Instant::now);
        let alignment = Alignment::new(self, zero);
        let mut events = Vec::new();
        for (number, frame) in self.frames.iter().enumerate() {
            self.frame(&mut events, number, frame, zero, &alignment);
        }
        let time = |event: &Value| event["ts"].as_f64().unwrap_or(0.0);
        // At one moment the longer span comes first, so that a frame holds its passes.
        let length = |event: &Value| event["dur"].as_f64().unwrap_or(0.0);
        events.sort_by(|a, b| time(a).total_cmp(&time(b)).then(length(b).total_cmp(&length(a))));
        let lane = |id: u32, name: &str| json!({ "ph": "M", "pid": 1, "tid": id, "name": "thread_name", "args": { "name": name } });
        let process = json!({ "ph": "M", "pid": 1, "name": "process_name", "args": { "name": "airglow" } });
        let lanes = [process, lane(CPU, "CPU: recording"), lane(DEVICE, "GPU: queue")];
        events.splice(0..0, lanes);
        json!({
            "displayTimeUnit": "ms",
            "otherData": {
                "device": self.machine.device,
                "driver": self.machine.driver,
                "clocks": alignment.description,
                "frames": self.frames.len(),
            },
            "traceEvents": events,
        })
    }

    fn frame(
        &self,
        events: &mut Vec<Value>,
        number: usize,
        frame: &FrameTimes,
        zero: Instant,
        alignment: &Alignment,
    ) {
        let cpu = |[begin, end]: [Instant; 2]| Span {
            lane: CPU,
            begin: begin.duration_since(zero).as_secs_f64(),
            end: end.duration_since(zero).as_secs_f64(),
        };
        let start = (self.seconds)(alignment.ticks, frame.start);
        let on_device = |from: f64, length: f64| {
            let begin = alignment.at + alignment.rate * (start + from);
            Span { lane: DEVICE, begin, end: begin + alignment.rate * length }
        };
        let name = format!("frame {}", frame.frame);
        if let (Some([begin, _]), Some([_, end])) = (frame.recorded.first(), frame.recorded.last()) {
            events.push(cpu([*begin, *end]).event(&name, json!({})));
        }
        events.push(on_device(0.0, frame.span).event(&name, json!({})));
        for (place, work) in self.passes.iter().enumerate() {
            let (Some(recorded), Some(begin), Some(length)) =
                (frame.recorded.get(place), frame.begins.get(place), frame.passes.get(place))
            else {
                continue;
            };
            let (recorded, worked) = (cpu(*recorded), on_device(*begin, *length));
            let counts: serde_json::Map<_, _> = work
                .counts
                .named()
                .into_iter()
                .map(|(name, count)| (name.to_owned(), count.into()))
                .collect();
            let id = number * self.passes.len() + place;
            events.push(recorded.event(&work.name, json!({})));
            events.push(worked.event(&work.name, counts.into()));
            events.extend([recorded.arrow("s", id), worked.arrow("f", id)]);
        }
    }
}

/// How the clocks of `context` are read.
pub fn seconds(context: &Context) -> impl Fn(u64, u64) -> f64 {
    |from, to| context.device_seconds(from, to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::model::testing;
    use airglow_gpu::Counts;
    use std::time::Duration;

    const TICK: f64 = 1e-9;

    fn frames(start: Instant) -> Vec<FrameTimes> {
        let at = |microseconds: u64| start + Duration::from_micros(microseconds);
        let frame = |number: u64, begin: u64| FrameTimes {
            frame: number,
            passes: vec![2e-3, 1e-3],
            begins: vec![0.0, 2e-3],
            start: 5_000_000 + 4_000_000 * number,
            span: 3e-3,
            sum: 3e-3,
            recorded: vec![[at(begin), at(begin + 10)], [at(begin + 10), at(begin + 30)]],
            statistics: Vec::new(),
        };
        vec![frame(0, 0), frame(1, 100)]
    }

    fn trace(calibrations: Option<[Calibration; 2]>, frames: &[FrameTimes]) -> Value {
        let work =
            |name: &str| PassWork { name: name.to_owned(), counts: Counts { draws: 3, ..Counts::default() } };
        let seconds = |from: u64, to: u64| TICK * (to as f64 - from as f64);
        let passes = [work("light"), work("draw")];
        let machine = testing::report("a device").machine;
        let trace = Trace { machine, passes: &passes, frames, seconds: &seconds, calibrations };
        serde_json::from_str(&serde_json::to_string(&trace.json()).unwrap()).unwrap()
    }

    /// Time and length of what is called `name` on a lane, in microseconds.
    fn spans(trace: &Value, lane: u32, name: &str) -> Vec<(f64, f64)> {
        let events = trace["traceEvents"].as_array().unwrap().iter();
        let here = events.filter(|event| event["ph"] == "X" && event["tid"] == lane && event["name"] == name);
        here.map(|event| (event["ts"].as_f64().unwrap(), event["dur"].as_f64().unwrap())).collect()
    }

    #[test]
    fn a_calibrated_trace_has_both_lanes_in_order_with_arrows() {
        let start = Instant::now();
        let calibration = |ticks: u64, microseconds: u64| Calibration {
            ticks,
            at: start + Duration::from_micros(microseconds),
            uncertainty: Duration::from_micros(2),
        };
        let frames = frames(start);
        // The device's clock shows 4.9 ms when the trace begins.
        let trace = trace(Some([calibration(4_900_000, 0), calibration(14_900_000, 10_000)]), &frames);
        assert_eq!(trace["otherData"]["clocks"], "calibrated; uncertain by 2.000 us");
        let events = trace["traceEvents"].as_array().unwrap();
        let named = |event: &&Value| event["name"] == "thread_name";
        let lanes: Vec<_> =
            events.iter().filter(named).map(|e| (e["tid"].as_u64().unwrap(), &e["args"]["name"])).collect();
        assert_eq!(lanes, [(1, &"CPU: recording".into()), (2, &"GPU: queue".into())]);
        let times: Vec<f64> = events.iter().filter_map(|event| event["ts"].as_f64()).collect();
        assert!(times.is_sorted(), "{times:?}");
        let close = |found: Vec<(f64, f64)>, expected: [(f64, f64); 2]| {
            let near =
                |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).abs() < 1e-6 && (a.1 - b.1).abs() < 1e-6;
            assert!(found.len() == 2 && found.iter().zip(&expected).all(near), "{found:?}, not {expected:?}");
        };
        close(spans(&trace, DEVICE, "draw"), [(2100.0, 1000.0), (6100.0, 1000.0)]);
        close(spans(&trace, CPU, "draw"), [(10.0, 20.0), (110.0, 20.0)]);
        let whole = [spans(&trace, CPU, "frame 0"), spans(&trace, CPU, "frame 1")].concat();
        close(whole, [(0.0, 30.0), (100.0, 30.0)]);
        let ends = |phase: &str| -> Vec<_> {
            let here = events.iter().filter(|event| event["ph"] == phase);
            here.map(|event| (event["id"].as_u64().unwrap(), event["ts"].as_f64().unwrap())).collect()
        };
        let (mut from, mut to) = (ends("s"), ends("f"));
        from.sort_by_key(|(id, _)| *id);
        to.sort_by_key(|(id, _)| *id);
        assert_eq!(from.len(), 4);
        assert!(from.iter().zip(&to).all(|(s, f)| s.0 == f.0 && s.1 <= f.1), "{from:?} {to:?}");
    }

    #[test]
    fn without_calibration_no_frame_begins_before_it_was_recorded() {
        let start = Instant::now();
        let frames = frames(start);
        let trace = trace(None, &frames);
        assert!(trace["otherData"]["clocks"].as_str().unwrap().starts_with("aligned at submission"));
        let [first, second] = spans(&trace, DEVICE, "light")[..] else { panic!("{trace}") };
        assert!((first.0 - 30.0).abs() < 1e-6 && (second.0 - 4030.0).abs() < 1e-6, "{first:?} {second:?}");
    }
}
