//! What a face is made of, as an MTL file says it.

use alloc::string::String;

/// What a face is made of, in the terms of an MTL file. The default is white and matt.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// `newmtl`; empty if the mesh does not come from a file.
    pub name: String,
    /// `Kd`: diffuse red, green, blue, as a rule 0 to 1.
    pub diffuse: [f32; 3],
    /// `Ks`: specular red, green, blue, as a rule 0 to 1.
    pub specular: [f32; 3],
    /// `Ns`: the specular exponent, as a rule 0 to 1,000.
    pub shininess: f32,
    /// `map_Kd`: the path of a texture, joined to the folder of the MTL file.
    pub texture: Option<String>,
}

impl Default for Surface {
    fn default() -> Self {
        Self { name: String::new(), diffuse: [1.0; 3], specular: [0.0; 3], shininess: 0.0, texture: None }
    }
}
