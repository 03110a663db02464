//! The window as its users see it, on a virtual X11 display: its pixels, its size, its keys, its ends.

#![cfg(all(feature = "view", feature = "relight", target_os = "linux"))]
#![expect(clippy::unwrap_used, clippy::panic, reason = "helpers of tests stop at the first surprise")]

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use glam::{Quat, Vec3};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConfigureWindowAux, ConnectionExt,
    EventMask, ImageFormat, ImageOrder, InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT, MOTION_NOTIFY_EVENT,
    MapState, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// Longer than anything here takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// Key codes of the keyboard that Xvfb has.
const ESCAPE: u8 = 9;
const R: u8 = 27;
const W: u8 = 25;
const V: u8 = 55;
const HOME: u8 = 110;
const P: u8 = 33;

/// An X server without a screen.
struct Display {
    server: Child,
    name: String,
}

impl Display {
    fn start() -> Self {
        let server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "800x1040x24", "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut server = server.unwrap_or_else(|error| {
            panic!("Xvfb did not start: {error}; install xvfb (tools/test.sh does)");
        });
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        assert!(!number.trim().is_empty(), "Xvfb found no free display");
        Self { server, name: format!(":{}", number.trim()) }
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// A scene with something for every pass but normal maps: a lamp before a cow, in fog, and a ball that casts a shadow.
const SCENE: &str = r#"
[[instance]]
file = "MESH/spot.glb"
[environment]
file = "ENV/courtyard_512.exr"
distance = 50
[medium]
visibility = 40
[[emitter]]
name = "lamp"
center = [0.9, 1.0, 0.9]
radius = 0.1
radiance = [40, 30, 20]
[[blocker]]
center = [0.0, 1.6, 0.3]
radius = 0.3
[quality]
order = 3
rays = 16
"#;

/// A running `airglow view`, and its user.
struct User {
    process: Child,
    connection: RustConnection,
    root: Window,
    window: Window,
    /// So long some frames take.
    frames: Duration,
}

impl User {
    /// Starts the command and waits for its window.
    fn start(display: &Display, mut command: Command) -> Self {
        let process = command.spawn().unwrap();
        let (connection, screen) = x11rb::connect(Some(&display.name)).unwrap();
        let setup = connection.setup();
        let root = setup.roots[screen].root;
        assert_eq!(setup.image_byte_order, ImageOrder::LSB_FIRST);
        let mut user = Self { process, connection, root, window: 0, frames: Duration::ZERO };
        user.wait("the window opens", |user| {
            let children = user.connection.query_tree(root).unwrap().reply().unwrap().children;
            let seen = |&window: &Window| {
                let attributes = user.connection.get_window_attributes(window).unwrap().reply();
                attributes.is_ok_and(|attributes| attributes.map_state == MapState::VIEWABLE)
            };
            children.into_iter().find(seen).inspect(|&window| user.window = window).is_some()
        });
        user
    }

    /// Waits until `done`; fails when that takes too long or the command has ended.
    fn wait(&mut self, what: &str, mut done: impl FnMut(&mut Self) -> bool) {
        let start = Instant::now();
        while !done(self) {
            assert_eq!(self.process.try_wait().unwrap(), None, "the command ended before {what}");
            assert!(start.elapsed() < PATIENCE, "waited in vain until {what}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// What is on the screen where the window is, RGB.
    fn pixels(&self, [width, height]: [u16; 2]) -> Vec<[u8; 3]> {
        let image = self.connection.get_image(ImageFormat::Z_PIXMAP, self.root, 0, 0, width, height, !0);
        let data = image.unwrap().reply().unwrap().data;
        data.as_chunks::<4>().0.iter().map(|&[blue, green, red, _]| [red, green, blue]).collect()
    }

    /// What `look` sees once that is something, and stands still.
    fn still(&mut self, look: impl Fn(&Self) -> Vec<[u8; 3]>) -> Vec<[u8; 3]> {
        let mut before = look(self);
        self.wait("the picture stands still", |user| {
            std::thread::sleep(user.frames.max(Duration::from_millis(100)));
            let now = look(user);
            std::mem::replace(&mut before, now.clone()) == now && now.iter().any(|texel| *texel != [0; 3])
        });
        before
    }

    fn wait_for_picture(&mut self, what: &str, picture: &Picture) {
        self.wait(what, |user| user.pixels(picture.size) == picture.pixels);
    }

    /// Plays an event of keyboard or mouse.
    fn play(&self, kind: u8, detail: u8, x: i16, y: i16) {
        self.connection.xtest_fake_input(kind, detail, 0, self.root, x, y, 0).unwrap().check().unwrap();
    }

    /// Presses and lets go.
    fn click(&self, [x, y]: [i16; 2]) {
        self.play(MOTION_NOTIFY_EVENT, 0, x, y);
        self.pause();
        self.play(BUTTON_PRESS_EVENT, 1, 0, 0);
        self.play(BUTTON_RELEASE_EVENT, 1, 0, 0);
    }

    /// Presses, drags by so many pixels to the right, and lets go.
    fn drag(&self, [x, y]: [i16; 2], right: i16) {
        self.play(MOTION_NOTIFY_EVENT, 0, x, y);
        self.pause();
        self.play(BUTTON_PRESS_EVENT, 1, 0, 0);
        self.pause();
        self.play(MOTION_NOTIFY_EVENT, 0, x + right, y);
        self.pause();
        self.play(BUTTON_RELEASE_EVENT, 1, 0, 0);
    }

    /// Some frames go by: a press and a move of one frame are no drag.
    fn pause(&self) {
        std::thread::sleep(self.frames);
    }

    fn press(&self, key: u8) {
        self.connection.set_input_focus(InputFocus::PARENT, self.window, 0_u32).unwrap().check().unwrap();
        self.play(KEY_PRESS_EVENT, key, 0, 0);
        self.play(KEY_RELEASE_EVENT, key, 0, 0);
    }

    /// The title bar's button, as a window manager tells it.
    fn close(&self) {
        let atom = |name: &[u8]| self.connection.intern_atom(false, name).unwrap().reply().unwrap().atom;
        let (protocols, delete) = (atom(b"WM_PROTOCOLS"), atom(b"WM_DELETE_WINDOW"));
        let message = ClientMessageEvent::new(32, self.window, protocols, [delete, 0, 0, 0, 0]);
        let sent = self.connection.send_event(false, self.window, EventMask::NO_EVENT, message);
        sent.unwrap().check().unwrap();
    }

    /// Waits for the command's end, which must be a good one; what it printed.
    fn end(mut self) -> serde_json::Value {
        let start = Instant::now();
        while self.process.try_wait().unwrap().is_none() {
            assert!(start.elapsed() < PATIENCE, "the command does not end");
            std::thread::sleep(Duration::from_millis(20));
        }
        // Kept alive until here: a server without clients starts over.
        let Self { process, .. } = self;
        printed(&process.wait_with_output().unwrap())
    }
}

fn printed(output: &Output) -> serde_json::Value {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "airglow view ended with {}: {errors}", output.status);
    serde_json::from_slice(&output.stdout).unwrap()
}

const SIZE: [u16; 2] = [320, 240];
const COMMON: [&str; 10] =
    ["--exposure", "1", "--samples", "1", "--rays", "16", "--device", "cpu", "--quiet", "--json"];

fn scene() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes/spot.toml")
}

/// The picture alone.
fn show(display: &Display, folder: &Path, more: &[&str]) -> Command {
    let mut command = view(display, folder, &scene(), "320x240");
    command.arg("--bare").args(more);
    command
}

fn view(display: &Display, folder: &Path, scene: &Path, size: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_airglow"));
    command.arg("view").arg(scene).args(COMMON).args(["--size", size, "--spin", "0", "--validate"]);
    command.current_dir(folder).env("DISPLAY", &display.name).env_remove("WAYLAND_DISPLAY");
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// What `airglow render` makes.
struct Picture {
    size: [u16; 2],
    pixels: Vec<[u8; 3]>,
}

fn render(folder: &Path, size @ [width, height]: [u16; 2], more: &[&str]) -> Picture {
    let mut command = Command::new(env!("CARGO_BIN_EXE_airglow"));
    command.arg("render").arg(scene()).args(COMMON).args(["-o", "a.png", "--frames", "1"]);
    let output =
        command.args(["--size", &format!("{width}x{height}")]).args(more).current_dir(folder).output();
    printed(&output.unwrap());
    let picture = airglow_scene::image_io::read_image(&folder.join("a.png")).unwrap();
    let byte = |value: f32| (255.0 * airglow_scene::srgb_encode(value)).round() as u8;
    Picture { size, pixels: picture.pixels.iter().map(|pixel| pixel.map(byte)).collect() }
}

/// Bit for bit, so that swapped channels, flipped axes or a stretched picture cannot go unnoticed.
#[test]
fn the_window_shows_what_render_draws_and_follows_its_user() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let relit = render(here, SIZE, &[]);
    let larger = render(here, [400, 300], &[]);
    let even = render(here, [400, 300], &["--without", "relight"]);
    let display = Display::start();
    let mut user = User::start(&display, show(&display, here, &[]));
    user.wait_for_picture("the window shows the picture", &relit);

    for width in (40..=400).step_by(10) {
        let size = ConfigureWindowAux::new().width(width).height(300);
        user.connection.configure_window(user.window, &size).unwrap().check().unwrap();
        std::thread::sleep(Duration::from_millis(5));
    }
    user.wait_for_picture("the picture has the window's new size", &larger);

    user.press(R);
    user.wait_for_picture("the pass is left out", &even);
    user.press(R);
    user.wait_for_picture("the pass is back", &larger);

    user.play(MOTION_NOTIFY_EVENT, 0, 200, 150);
    user.play(BUTTON_PRESS_EVENT, 1, 0, 0);
    user.play(MOTION_NOTIFY_EVENT, 0, 240, 160);
    user.play(BUTTON_RELEASE_EVENT, 1, 0, 0);
    user.wait("the camera has moved", |user| user.pixels(larger.size) != larger.pixels);
    user.press(HOME);
    user.wait_for_picture("the camera is back", &larger);

    user.connection.unmap_window(user.window).unwrap().check().unwrap();
    user.wait("the window is gone", |user| user.pixels(larger.size) != larger.pixels);
    user.connection.map_window(user.window).unwrap().check().unwrap();
    user.wait_for_picture("the window is back", &larger);

    user.play(MOTION_NOTIFY_EVENT, 0, 200, 150);
    user.play(BUTTON_PRESS_EVENT, 1, 0, 0);
    user.play(MOTION_NOTIFY_EVENT, 0, 250, 140);
    user.play(BUTTON_RELEASE_EVENT, 1, 0, 0);
    user.wait("the camera goes around", |user| user.pixels(larger.size) != larger.pixels);
    let around = user.still(|user| user.pixels(larger.size));
    user.press(V);
    user.play(KEY_PRESS_EVENT, W, 0, 0);
    user.wait("the camera flies", |user| user.pixels(larger.size) != around);
    user.play(KEY_RELEASE_EVENT, W, 0, 0);

    user.press(ESCAPE);
    let shown = user.end();
    assert!(shown["frames"].as_u64().unwrap() >= 5, "{shown}");
    check_flight(&shown["camera"], [50.0, -10.0]);
}

/// The camera went around the scene as the mouse was dragged by so many pixels, 0.008 radians each, then ahead.
fn check_flight(camera: &serde_json::Value, [right, down]: [f32; 2]) {
    let scene = airglow_scene::load(&scene()).unwrap();
    let (home, middle) = (scene.camera(), Vec3::from(scene.bounding_sphere().unwrap().center));
    let vector = |key: &str| Vec3::from(serde_json::from_value::<[f32; 3]>(camera[key].clone()).unwrap());
    let side = home.transform.x_axis.truncate().normalize();
    let turn = Quat::from_rotation_y(-0.008 * right) * Quat::from_axis_angle(side, -0.008 * down);
    let expected = turn * home.direction();
    assert!(vector("direction").distance(expected) < 1e-3, "{camera}: it does not look along {expected}");
    let distance = (middle - home.position()).dot(home.direction());
    let start = home.position() + distance * (home.direction() - expected);
    let flown = vector("position") - start;
    let ahead = flown.dot(expected);
    assert!(ahead > 1e-3 && flown.distance(ahead * expected) < 1e-3, "from {start} by {flown}");
}

#[test]
fn the_window_can_be_closed_and_closes_after_its_frames() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let display = Display::start();
    let user = User::start(&display, show(&display, here, &[]));
    user.close();
    user.end();
    let shown = printed(&show(&display, here, &["--frames", "5"]).output().unwrap());
    assert_eq!(shown["frames"], 5, "{shown}");
    let passes: Vec<_> = shown["passes"].as_array().unwrap().iter().map(|pass| &pass["name"]).collect();
    assert_eq!(passes.last(), Some(&&"interface".into()), "{shown}");
}

/// Where a part of the panel is in its middle.
fn middle(shown: &serde_json::Value, name: &str) -> [i16; 2] {
    let rect: Vec<f64> =
        shown["panel"][name].as_array().unwrap().iter().map(|side| side.as_f64().unwrap()).collect();
    [(rect[0] + rect[2]) / 2.0, (rect[1] + rect[3]) / 2.0].map(|side| side as i16)
}

#[test]
fn the_panel_switches_passes_turns_knobs_and_moves_lamps() {
    let folder = tempfile::tempdir().unwrap();
    let (here, file) = (folder.path(), folder.path().join("scene.toml"));
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets").canonicalize().unwrap();
    let below = |name: &str| assets.join(name).display().to_string();
    std::fs::write(&file, SCENE.replace("MESH", &below("mesh")).replace("ENV", &below("env"))).unwrap();
    let display = Display::start();
    let command = || view(&display, here, &file, "720x1000");
    let shown = printed(&command().args(["--frames", "8"]).output().unwrap());
    let mut user = User::start(&display, command());
    let rate = shown["frames_per_second"].as_f64().unwrap();
    // The first frames were slower, as pipelines were made.
    user.frames = Duration::from_secs_f64((2.0 / rate).max(0.1));
    let picture = |user: &User| -> Vec<[u8; 3]> {
        let rows = user.pixels([720, 1000]);
        rows.chunks(720).flat_map(|row| row[360..].to_vec()).collect()
    };
    let changes = |user: &mut User, what: &str, act: &dyn Fn(&User)| {
        let before = user.still(picture);
        act(user);
        user.wait(what, |user| picture(user) != before);
    };
    for pass in ["fog", "shadow", "radiance"] {
        changes(&mut user, pass, &|user| user.click(middle(&shown, pass)));
        changes(&mut user, pass, &|user| user.click(middle(&shown, pass)));
    }
    changes(&mut user, "the lamp follows the mouse", &|user| user.drag(middle(&shown, "ring of lamp"), -60));
    let [x, y] = middle(&shown, "shadow window");
    changes(&mut user, "the shadows ring less", &|user| user.drag([x - 100, y], 60));
    changes(&mut user, "the picture is brighter", &|user| {
        let [x, y] = middle(&shown, "exposure");
        user.drag([x - 62, y], 30);
    });
    user.press(P);
    let path = here.join("view.png");
    user.wait("the picture is written", |_| path.exists());
    let written = airglow_scene::image_io::read_image(&path).unwrap();
    assert_eq!([written.width, written.height], [720, 1000]);
    let size = ConfigureWindowAux::new().width(500).height(400);
    user.connection.configure_window(user.window, &size).unwrap().check().unwrap();
    user.wait("the window is smaller", |user| user.pixels([720, 1000])[600] == [0; 3]);
    user.press(ESCAPE);
    user.end();
}

#[test]
fn without_a_display_the_command_says_so_before_it_bakes() {
    let folder = tempfile::tempdir().unwrap();
    for display in [None, Some(":nowhere")] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_airglow"));
        command.arg("view").arg(scene()).current_dir(folder.path());
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        let output = command.envs(display.map(|display| ("DISPLAY", display))).output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{errors}");
        assert!(errors.contains("no window can be opened") && errors.contains("airglow render"), "{errors}");
        assert!(!errors.contains(".rs"), "no places in sources: {errors}");
        assert!(!folder.path().join(".cache").exists(), "nothing is baked");
    }
}
