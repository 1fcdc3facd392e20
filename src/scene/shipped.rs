//! The scenes that are compiled in, by name. Their files are in `scenes/`, and name no file: their palettes and
//! textures are compiled in, too.

use std::io;
use std::path::Path;

use super::Scene;
use super::file::{Loaded, SceneError};

/// A scene that is compiled in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Shipped {
    /// Its name on the command line.
    pub name: &'static str,
    /// The text of its file.
    pub text: &'static str,
}

/// The table of scenes, a row each: its file's name without the extension.
macro_rules! shipped {
    ($($name:literal)*) => {
        [$(Shipped { name: $name, text: include_str!(concat!("../../scenes/", $name, ".toml")) }),*]
    };
}

/// All scenes that are compiled in, in the order in which they are best looked at.
pub static ALL: [Shipped; 18] = shipped! {
    "torus" "cube" "teapot" "cone" "phong" "phong-table" "flash" "flash-tessellated" "two-lights" "fog" "rgb" "crate"
    "mirror" "interlock" "glenz" "fade" "cycle" "still"
};

/// The scene of a name, exactly as in [`ALL`]. Returns `None` if there is none.
///
/// ```
/// use mode13h::scene::shipped;
/// let torus = shipped::by_name("torus").expect("it is shipped").load()?.scene;
/// assert_eq!(torus.objects().len(), 1);
/// # Ok::<(), mode13h::scene::file::SceneError>(())
/// ```
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Shipped> {
    ALL.iter().find(|shipped| shipped.name == name)
}

impl Shipped {
    /// The scene's subject, in one line: the first of its file.
    #[must_use]
    #[doc(hidden)]
    pub fn shows(&self) -> &'static str {
        self.text.lines().next().unwrap_or_default().trim_start_matches(['#', ' '])
    }

    /// The scene itself.
    ///
    /// # Errors
    /// None, as the tests of this crate see to; those of [`Scene::from_toml`] in principle.
    pub fn load(&self) -> Result<Loaded, SceneError> {
        let no_files = |_: &Path| Err(io::ErrorKind::NotFound.into());
        Scene::from_toml(self.text, std::format!("{}.toml", self.name), no_files)
    }
}
