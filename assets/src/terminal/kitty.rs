//! kitty's graphics protocol: a PNG in base64, in chunks of at most 4,096 bytes.
//!
//! ```text
//! ESC _ G keys , m=1 ; base64 ESC \      the first chunk: a=T shows it, f=100 is PNG, q=2 asks for no answer
//! ESC _ G m=1 ; base64 ESC \             more of them
//! ESC _ G m=0 ; base64 ESC \             the last
//! ```
//!
//! Source: <https://sw.kovidgoyal.net/kitty/graphics-protocol/>.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use mode13h::export::{Picture, PictureError, Png, Scale};

/// Bytes of base64 in a chunk, at most; a multiple of 4.
const CHUNK: usize = 4096;

/// A picture with more `keys`, each after a comma.
pub(super) fn picture(picture: &Picture<'_>, scale: Scale, keys: &str) -> Result<String, PictureError> {
    let png = Png { scale, rgb: false }.encode(picture)?;
    let mut text = String::with_capacity(png.len() * 4 / 3 + png.len() / 128 + 64);
    let mut keys = format!("a=T,f=100,q=2{keys},");
    let mut chunks = png.chunks(CHUNK / 4 * 3).peekable();
    while let Some(chunk) = chunks.next() {
        let more = u8::from(chunks.peek().is_some());
        text.push_str(&format!("\x1b_G{keys}m={more};"));
        STANDARD.encode_string(chunk, &mut text);
        text.push_str("\x1b\\");
        keys.clear();
    }
    Ok(text)
}
