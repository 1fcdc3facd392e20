//! Indexed pictures, written here byte by byte.

use std::io::{Cursor, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use mode13h::palette::Rgb;

use super::{Decoded, decode_all};

fn decoded(bytes: &[u8]) -> Decoded {
    decode_all(Cursor::new(bytes)).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(bytes: &[u8]) -> String {
    let error = decode_all(Cursor::new(bytes)).map(|_| ()).expect_err("no picture").to_string();
    error.strip_prefix("not a picture that can be read: ").expect("what is wrong").into()
}

/// A palette with 256 distinct entries.
fn color(index: u8) -> Rgb {
    Rgb::new(index, 255 - index, index / 2)
}

fn palette() -> Vec<u8> {
    (0..=255).map(color).flat_map(|Rgb { r, g, b }| [r, g, b]).collect()
}

/// The indices of a picture of 8 × 4 from the top down: runs, and values that a PCX must write as runs of one.
const PICTURE: [u8; 32] = [
    0, 0, 0, 0, 0, 7, 255, 192, //
    9, 9, 1, 2, 3, 4, 5, 6, //
    200, 200, 200, 200, 200, 200, 200, 200, //
    200, 1, 193, 193, 0, 255, 255, 8,
];

/// Checks that the indices are preserved; rows of texels run from the bottom up.
fn assert_kept(bytes: &[u8]) {
    let texture = decoded(bytes).texture;
    let expected: Vec<u8> = PICTURE.chunks(8).rev().flatten().copied().collect();
    assert_eq!((texture.width(), texture.height(), texture.texels()), (8, 4, &expected[..]));
    assert_eq!(texture.colors().to_vec(), (0..=255).map(color).collect::<Vec<_>>());
}

fn pcx(width: u16, pitch: u16, rows: &[&[u8]]) -> Vec<u8> {
    let mut bytes = vec![10, 5, 1, 8, 3, 0, 2, 0];
    bytes.extend((3 + width - 1).to_le_bytes());
    bytes.extend((2 + rows.len() as u16 - 1).to_le_bytes());
    bytes.resize(65, 0);
    bytes.push(1);
    bytes.extend(pitch.to_le_bytes());
    bytes.resize(128, 0);
    for row in rows {
        let row: Vec<u8> = row.iter().copied().chain([77]).take(pitch.into()).collect();
        for run in row.chunk_by(|a, b| a == b) {
            match run {
                [one] if *one < 192 => bytes.push(*one),
                run => bytes.extend([192 + run.len() as u8, run[0]]),
            }
        }
    }
    bytes.push(12);
    bytes.extend(palette());
    bytes
}

#[test]
fn a_pcx_keeps_its_indices() {
    let rows: Vec<&[u8]> = PICTURE.chunks(8).collect();
    // Rows may be longer than the picture is wide.
    for pitch in [8, 9] {
        assert_kept(&pcx(8, pitch, &rows));
    }
    let whole = pcx(8, 8, &rows);
    assert_eq!(refused(&whole[..100]), "PCX: the header is cut short");
    assert_eq!(refused(&whole[..400]), "PCX: there is no palette at the end");
    assert_eq!(refused(&pcx(8, 8, &rows[..0])), "PCX: rows are shorter than the picture is wide");
    let mut planes = whole.clone();
    planes[65] = 3;
    assert_eq!(refused(&planes), "PCX: 8 bits in 3 planes; only 8 bits in one plane are supported");
    // If no texture can have the size, the colours are resampled.
    let Decoded { texture, palette, .. } = decoded(&pcx(6, 6, &[&[1; 6], &[2; 6], &[3; 6]]));
    assert_eq!((texture.width(), texture[(0, 0)]), (8, color(3)));
    assert_eq!(palette.map(|colors| colors[200]), Some(color(200)), "the palette is whole all the same");
}

#[test]
fn a_gif_keeps_its_indices() {
    let write = |transparent: Option<u8>, of_frame: bool| {
        let mut bytes = Vec::new();
        let global = if of_frame { Vec::new() } else { palette() };
        let mut encoder = gif::Encoder::new(&mut bytes, 8, 4, &global).expect("a header");
        let mut frame = gif::Frame::from_indexed_pixels(8, 4, PICTURE.to_vec(), transparent);
        frame.palette = of_frame.then(palette);
        encoder.write_frame(&frame).expect("a frame");
        drop(encoder);
        bytes
    };
    for of_frame in [false, true] {
        assert_kept(&write(None, of_frame));
        assert_kept(&write(Some(9), of_frame));
    }
    assert!(!decoded(&write(None, false)).was_transparent);
    assert!(decoded(&write(Some(9), false)).was_transparent);
    assert!(!decoded(&write(Some(10), false)).was_transparent);
}

fn chunk(kind: u16, body: &[u8]) -> Vec<u8> {
    [&(body.len() as u32 + 6).to_le_bytes()[..], &kind.to_le_bytes(), body].concat()
}

fn layer(flags: u16, kind: u16, level: u16) -> Vec<u8> {
    chunk(0x2004, &[&[flags, kind, level, 0, 0, 0].map(u16::to_le_bytes).concat()[..], &[255, 0, 0, 0, 0, 0]].concat())
}

fn cel(layer: u16, place: [i16; 2], size: [u16; 2], pixels: &[u8], packed: bool) -> Vec<u8> {
    let mut body = layer.to_le_bytes().to_vec();
    body.extend(place.map(i16::to_le_bytes).concat());
    body.push(255);
    body.extend(if packed { 2_u16 } else { 0 }.to_le_bytes());
    body.extend([0; 7]);
    body.extend(size.map(u16::to_le_bytes).concat());
    if packed {
        let mut packer = ZlibEncoder::new(&mut body, Compression::default());
        packer.write_all(pixels).expect("packed");
        packer.finish().expect("packed");
    } else {
        body.extend(pixels);
    }
    chunk(0x2005, &body)
}

fn sprite(bits: u16, transparent: u8, chunks: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = vec![0; 4];
    bytes.extend([0xA5E0, 1, 8, 4, bits].map(u16::to_le_bytes).concat());
    bytes.resize(28, 0);
    bytes.push(transparent);
    bytes.resize(128, 0);
    bytes.extend([0; 4]);
    bytes.extend([0xF1FA, chunks.len() as u16, 100, 0].map(u16::to_le_bytes).concat());
    bytes.extend((chunks.len() as u32).to_le_bytes());
    bytes.extend(chunks.concat());
    bytes
}

fn new_palette() -> Vec<u8> {
    let mut body = [256_u32, 0, 255].map(u32::to_le_bytes).concat();
    body.extend([0; 8]);
    for index in 0..=255 {
        let Rgb { r, g, b } = color(index);
        // Every third has a name.
        let named = index % 3 == 0;
        body.extend([u8::from(named), 0, r, g, b, 255]);
        body.extend(if named { &b"\x02\0ab"[..] } else { b"" });
    }
    chunk(0x2019, &body)
}

#[test]
fn a_sprite_keeps_its_indices() {
    let old = chunk(0x0004, &[&[1, 0, 0, 0][..], &palette()].concat());
    for colors in [vec![new_palette()], vec![old.clone()], vec![new_palette(), chunk(0x0004, &[1, 0, 0, 1, 9, 9, 9])]] {
        for packed in [false, true] {
            let rest = [layer(9, 0, 0), cel(0, [0, 0], [8, 4], &PICTURE, packed)];
            assert_kept(&sprite(8, 0, &[colors.clone(), rest.to_vec()].concat()));
        }
    }
    // The card's six bits.
    let dac = chunk(0x0011, &[2, 0, 1, 1, 63, 0, 32, 2, 1, 1, 2, 3]);
    let texture = decoded(&sprite(8, 0, &[dac, layer(9, 0, 0), cel(0, [0, 0], [8, 4], &PICTURE, false)])).texture;
    assert_eq!(
        [1, 4, 2].map(|i| texture.colors()[i]),
        [Rgb::from_dac([63, 0, 32]), Rgb::from_dac([1, 2, 3]), Rgb::BLACK]
    );
}

/// A cel's z-index moves it among the layers, and a reference layer is not part of the picture.
#[test]
fn cels_of_a_sprite_are_drawn_in_their_order() {
    let full = |of_layer, index, z: i16| {
        let mut cel = cel(of_layer, [0, 0], [8, 4], &[index; 32], false);
        // After the chunk's size and type, layer, position, opacity and type.
        cel[15..17].copy_from_slice(&z.to_le_bytes());
        cel
    };
    for (z, top, shown) in [(0, 1, 6), (1, 1, 5), (2, 1, 5), (-1, 1, 6), (0, 1 | 64, 5)] {
        let chunks = [new_palette(), layer(1, 0, 0), layer(top, 0, 0), full(0, 5, z), full(1, 6, 0)];
        assert_eq!(decoded(&sprite(8, 4, &chunks)).texture.texels(), [shown; 32], "{z}, {top}");
    }
}

/// Visible layers cover one another; the transparent index shows what is below; cels may reach beyond the sprite.
#[test]
fn layers_of_a_sprite() {
    let chunks = [
        new_palette(),
        layer(1, 0, 0),
        layer(0, 1, 0),
        layer(1, 0, 1),
        layer(1, 0, 0),
        cel(0, [1, 1], [3, 2], &[5, 5, 5, 5, 5, 5], false),
        cel(2, [0, 0], [8, 4], &[6; 32], true),
        cel(3, [2, -1], [2, 3], &[7, 7, 7, 4, 7, 7], true),
    ];
    let Decoded { texture, was_transparent, .. } = decoded(&sprite(8, 4, &chunks));
    let rows = [[4, 4, 7, 4, 4, 4, 4, 4], [4, 5, 7, 7, 4, 4, 4, 4], [4, 5, 5, 5, 4, 4, 4, 4], [4; 8]];
    assert_eq!(texture.texels(), rows.into_iter().rev().flatten().collect::<Vec<u8>>());
    assert!(was_transparent);
    assert_eq!(refused(&sprite(32, 0, &[])), "Aseprite: not an indexed sprite");
    let whole = sprite(8, 0, &chunks);
    assert_eq!(refused(&whole[..whole.len() - 1]), "Aseprite: the file is cut short");
    assert_eq!(
        refused(&sprite(8, 0, &[cel(0, [0, 0], [1, 1], &[1], false)])),
        "Aseprite: a cel of a layer that does not exist"
    );
}
