//! The four ways to leave out hidden surfaces, and which one a scene calls for.

use alloc::vec::Vec;
use core::fmt;
use core::str::FromStr;

use super::painter;
use super::view::ObjectView;
use crate::scene::Scene;

/// How hidden surfaces are left out.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum HiddenSurfaces {
    /// Faces turned away are not drawn; that is enough for one convex object.
    BackFaces,
    /// Far to near, each over what is there. Right for convex objects that lie one behind the other,
    /// drawn object by object. Asked for, it is the painter's algorithm face by face, by the mean
    /// depth of a face's vertices: wrong where faces overlap in a circle or pass through each other.
    PainterOrder,
    /// A depth for every pixel.
    DepthBuffer,
    /// All faces of the frame at once, row by row, each pixel written once
    /// ([`raster::scan_line`](crate::raster::scan_line)). The same bytes as with the depth buffer.
    ScanLine,
}

impl HiddenSurfaces {
    /// Every way.
    pub const ALL: [Self; 4] = [Self::BackFaces, Self::PainterOrder, Self::DepthBuffer, Self::ScanLine];

    /// Its name, as it is typed.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::BackFaces => "back-faces",
            Self::PainterOrder => "painter",
            Self::DepthBuffer => "depth-buffer",
            Self::ScanLine => "scan-line",
        }
    }

    /// The way that a scene calls for: the cheapest that is right. Its objects are put in `order`: far
    /// to near for painter's order, else as they are.
    ///
    /// One convex object hides nothing but its own back faces. Of several that are convex and whose
    /// depths are apart, the nearer hides the farther, whole. All else needs a depth for every pixel.
    pub(super) fn called_for(scene: &Scene, views: &[ObjectView], order: &mut Vec<usize>) -> Self {
        let objects = scene.objects();
        order.clear();
        order.extend(0..objects.len());
        let convex = objects.iter().all(|object| object.mesh().is_convex());
        match objects {
            [] => Self::BackFaces,
            [_] if convex => Self::BackFaces,
            _ if convex && painter::far_to_near(objects, views, order) => Self::PainterOrder,
            _ => Self::DepthBuffer,
        }
    }
}

impl fmt::Display for HiddenSurfaces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// There is no way to leave out hidden surfaces of that name. Its text lists those there are.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct UnknownHiddenSurfaces;

impl fmt::Display for UnknownHiddenSurfaces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("unknown way to hidden surfaces; there are")?;
        for (i, way) in HiddenSurfaces::ALL.iter().enumerate() {
            write!(f, "{} {way}", if i == 0 { "" } else { "," })?;
        }
        Ok(())
    }
}

impl core::error::Error for UnknownHiddenSurfaces {}

impl FromStr for HiddenSurfaces {
    type Err = UnknownHiddenSurfaces;

    fn from_str(name: &str) -> Result<Self, UnknownHiddenSurfaces> {
        Self::ALL.into_iter().find(|way| way.name() == name).ok_or(UnknownHiddenSurfaces)
    }
}
