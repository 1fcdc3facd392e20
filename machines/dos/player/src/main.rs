//! Plays a film of projected scenes in the mode 13h of a real VGA, on a 386 without a floating-point unit. `stub.asm`
//! has entered protected mode and calls [`play`].
//!
//! | argument | what |
//! |---|---|
//! | none | the scene, repeated until Esc |
//! | `/H` | draws all frames once, and prints their hash |
//! | `/B` | does the same, then draws as many frames as it can in ten seconds, and prints the number per second |
//! | `/T` | draws all frames once, and prints the time per frame by the timer |
//! | `/W n` | shows frame n, and writes the card's contents to SCREEN.BIN: 64,000 bytes, and 768 of the DAC |
#![no_std]
#![no_main]

extern crate alloc;

#[path = "../../../../cli/src/dos/player.rs"]
mod film;
#[path = "../../../../conformance/src/hash.rs"]
mod hash;
mod machine;
#[path = "../../../../cli/src/dos/unpack.rs"]
mod unpack;

use alloc::format;
use alloc::vec;
use film::{Film, PIXELS, Player};
use hash::{START, fnv_1a};
use machine::{Machine, Parameters};
use mode13h::span::Kernel;
use unpack::unpack;

/// Called by the stub that precedes it; returns the program's exit status.
///
/// # Safety
/// The stub passes its own table.
#[unsafe(link_section = ".entry")]
#[unsafe(no_mangle)]
unsafe extern "C" fn play(parameters: *mut Parameters) -> u32 {
    // SAFETY: it is the stub's, which calls once.
    let (mut machine, film, words) = unsafe { Machine::new(parameters) };
    match run(&mut machine, film, words) {
        Ok(()) => 0,
        Err(line) => {
            machine.set_mode(Machine::TEXT);
            machine.print(line);
            1
        }
    }
}

fn run(machine: &mut Machine, bytes: &[u8], words: &[u8]) -> Result<(), &'static str> {
    const BROKEN: &str = "The scene in this program is broken.\n";
    let bytes = unpack(bytes).ok_or(BROKEN)?;
    let film = Film::read(&bytes).ok_or(BROKEN)?;
    let kernel = "asm".parse::<Kernel>().unwrap_or(Kernel::PORTABLE);
    let mut player = Player::new(&film, kernel).ok_or(BROKEN)?;
    let mut pixels = vec![0; PIXELS];
    let words = core::str::from_utf8(words).unwrap_or_default();
    let mut words = words.split_ascii_whitespace();
    let word = words.next().unwrap_or_default();
    match (word, words.next()) {
        ("", None) => {
            machine.set_mode(Machine::MODE_13H);
            machine.set_dac(film.dac, 0);
            let mut number = 0;
            player.draw(number, &mut pixels).ok_or(BROKEN)?;
            machine.show(&pixels);
            machine.fade(film.dac, false);
            while !machine.is_escaped() {
                number = (number + 1) % film.frames();
                player.draw(number, &mut pixels).ok_or(BROKEN)?;
                machine.wait_for_retrace();
                machine.show(&pixels);
            }
            machine.fade(film.dac, true);
            machine.set_mode(Machine::TEXT);
        }
        ("/H" | "/h" | "/B" | "/b", None) => {
            machine.set_mode(Machine::MODE_13H);
            machine.set_dac(film.dac, 64);
            let mut sum = START;
            for number in 0..film.frames() {
                player.draw(number, &mut pixels).ok_or(BROKEN)?;
                sum = fnv_1a(sum, &pixels);
            }
            sum = fnv_1a(sum, film.dac);
            let said = format!("{} frames, {sum:016x}", film.frames());
            if word.eq_ignore_ascii_case("/H") {
                machine.set_mode(Machine::TEXT);
                machine.print(&format!("{said}\n"));
                return Ok(());
            }
            // From one change of the clock's second to another, at least ten seconds later.
            let (mut frames, mut seconds) = (0_u32, 0);
            let mut last = machine.seconds();
            while last == machine.seconds() {}
            last = machine.seconds();
            while seconds < 10 {
                player.draw(frames as usize % film.frames(), &mut pixels).ok_or(BROKEN)?;
                machine.show(&pixels);
                frames += 1;
                let now = machine.seconds();
                seconds += (now + 60 - last) % 60;
                last = now;
            }
            machine.set_mode(Machine::TEXT);
            let hundredths = frames * 100 / seconds;
            machine.print(&format!("{said}, {}.{:02} a second\n", hundredths / 100, hundredths % 100));
        }
        ("/T" | "/t", None) => {
            machine.set_mode(Machine::MODE_13H);
            machine.set_dac(film.dac, 64);
            machine.start_timer();
            let mut ticks = 0;
            for number in 0..film.frames() {
                machine.rest_of_second();
                player.draw(number, &mut pixels).ok_or(BROKEN)?;
                machine.show(&pixels);
                if machine.is_second_over() {
                    return Err("A frame takes more than a second.\n");
                }
                // A second minus what is left of it.
                ticks += Machine::TICKS - machine.rest_of_second().min(Machine::TICKS);
            }
            machine.set_mode(Machine::TEXT);
            let count = film.frames();
            // At most 1,024 frames, so both products are below 2³².
            let microseconds = ticks / count as u32 * 1000 / (Machine::TICKS / 1000);
            machine.print(&format!("{count} frames, {microseconds} microseconds each\n"));
        }
        ("/W" | "/w", Some(number)) if number.parse::<usize>().is_ok() => {
            machine.set_mode(Machine::MODE_13H);
            machine.set_dac(film.dac, 64);
            player.draw(number.parse().unwrap_or(0), &mut pixels).ok_or(BROKEN)?;
            machine.show(&pixels);
            let written = machine.write_screen();
            machine.set_mode(Machine::TEXT);
            if !written {
                return Err("SCREEN.BIN cannot be written.\n");
            }
        }
        _ => {
            return Err(
                "Without a word: the scene, until Esc. /B: frames a second. /H: hash. /W n: frame n to SCREEN.BIN.\n",
            );
        }
    }
    Ok(())
}
