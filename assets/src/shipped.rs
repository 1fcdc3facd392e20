//! The built-in scenes, by name. Their files are in `assets/scenes/`, and refer to no other files: their palettes and
//! textures are built in, too.

use std::io;
use std::path::Path;
use std::str::FromStr;

use mode13h::UnknownName;
use mode13h::scene::Scene;

use crate::SceneExt;
use crate::scene_file::{Loaded, SceneError};

/// A built-in scene.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Shipped {
    /// The name, as used on the command line.
    pub name: &'static str,
    /// The text of its file.
    pub text: &'static str,
}

/// Lists the scenes by file name without the extension.
macro_rules! shipped {
    ($($name:literal)*) => {
        /// All built-in scenes, in a good order for viewing.
        pub static ALL: [Shipped; NAMES.len()] =
            [$(Shipped { name: $name, text: include_str!(concat!("../scenes/", $name, ".toml")) }),*];
        const NAMES: [&str; [$($name),*].len()] = [$($name),*];
    };
}

shipped! {
    "torus" "cube" "teapot" "cone" "phong" "phong-table" "flash" "flash-tessellated" "two-lights" "fog" "rgb" "crate"
    "mirror" "interlock" "glenz" "fade" "cycle" "still"
}

/// The scene with a name, spelled as in [`ALL`].
///
/// ```
/// use mode13h_assets::shipped::Shipped;
/// let torus = "torus".parse::<Shipped>()?.load()?.scene;
/// assert_eq!(torus.objects().len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
impl FromStr for Shipped {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        ALL.into_iter().find(|shipped| shipped.name == name).ok_or(UnknownName::of("scene", &NAMES))
    }
}

impl Shipped {
    /// The scene's subject, in one line: the first line of its file.
    #[must_use]
    pub fn shows(&self) -> &'static str {
        self.text.lines().next().unwrap_or_default().trim_start_matches(['#', ' '])
    }

    /// Loads the scene.
    ///
    /// # Errors
    /// None, which this crate's tests ensure; in principle those of [`Scene::from_toml`].
    pub fn load(&self) -> Result<Loaded, SceneError> {
        let no_files = |_: &Path| Err(io::ErrorKind::NotFound.into());
        Scene::from_toml(self.text, std::format!("{}.toml", self.name), no_files)
    }
}
