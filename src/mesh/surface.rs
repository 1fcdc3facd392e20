//! Surfaces of faces, as an MTL file describes them.

use alloc::string::String;

use crate::palette::Rgb;

/// A face's surface, in the terms of an MTL file. The default is white and matt.
///
/// [`Object::new`](crate::scene::Object::new) documents which of these properties are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// `newmtl`; empty if the mesh does not come from a file.
    pub name: String,
    /// `Kd`: diffuse red, green, blue, usually 0 to 1.
    pub diffuse: [f32; 3],
    /// `Ks`: specular red, green, blue, usually 0 to 1.
    pub specular: [f32; 3],
    /// `Ns`: the specular exponent, usually 0 to 1,000. 0, or none in the file, means no highlight.
    pub shininess: f32,
    /// `d`, or 1 − `Tr`: how much the surface hides of what lies behind it, 0 to 1. 1 is opaque, and so is 0, which
    /// some exporters write for opaque surfaces.
    pub opacity: f32,
    /// `map_Kd`: the path of a texture, joined to the folder of the MTL file.
    pub texture: Option<String>,
}

impl Default for Surface {
    fn default() -> Self {
        Self { name: String::new(), diffuse: [1.0; 3], specular: [0.0; 3], shininess: 0.0, opacity: 1.0, texture: None }
    }
}

impl Surface {
    /// The colour in full light: `Kd`, each channel rounded to the nearest of 0 to 255. Values below 0 and NaN count as
    /// 0, values above 1 as 1.
    #[must_use]
    pub fn color(&self) -> Rgb {
        Rgb::from_intensities(self.diffuse)
    }

    /// The colour in the middle of a highlight: `Kd` plus `Ks`, each channel at most 255. `None` for a matt surface:
    /// either `Ks` is black, or the exponent `Ns` is not above 0, so the highlight would be everywhere.
    ///
    /// ```
    /// use mode13h::mesh::Surface;
    /// use mode13h::palette::Rgb;
    /// let brass = Surface { diffuse: [0.6, 0.4, 0.2], specular: [0.5; 3], shininess: 20.0, ..Surface::default() };
    /// assert_eq!(brass.color(), Rgb::new(153, 102, 51));
    /// assert_eq!(brass.highlight(), Some(Rgb::new(255, 230, 179)));
    /// assert_eq!(Surface::default().highlight(), None);
    /// ```
    #[must_use]
    pub fn highlight(&self) -> Option<Rgb> {
        let specular = Rgb::from_intensities(self.specular);
        let is_shiny = specular != Rgb::BLACK && self.shininess > 0.0;
        is_shiny.then(|| self.color().saturating_add(specular))
    }
}
