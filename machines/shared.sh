# What the scripts machines/*/run have in common; they source it.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# One place for all: core and alloc are built once for a target and kept.
machines=${MACHINES_TARGET:-$root/target/machines}
mkdir -p "$machines"
wrong=0

# needs PACKAGE...: installs what is not there.
needs() {
    local package missing=()
    for package; do
        dpkg-query -W -f '${Status}\n' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
    done
    # Another machine may be installing at this moment.
    [ ${#missing[@]} = 0 ] ||
        apt-get -o DPkg::Lock::Timeout=600 install -q -y --no-install-recommends "${missing[@]}" >&2
}

# compiled TARGET [RUSTFLAGS...]: builds the program for a target with core and alloc, and nothing else. Debian's
# compiler brings their source; rustup's has it as the component rust-src.
compiled() {
    local target=$1
    shift
    needs rustc-web cargo-web rust-web-src rust-web-llvm
    # rust-lld names the linker that belongs to this compiler, and links for all of these processors.
    needs "$(basename "$(readlink /usr/bin/rust-lld)")"
    local flags="$* -C linker=rust-lld -C linker-flavor=${linker:-ld.lld} -C relocation-model=${relocation:-static}"
    RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 RUSTFLAGS=$flags /usr/bin/cargo build -q --release \
        --manifest-path "$root/machines/frames/Cargo.toml" --target-dir "$machines" --target "$target" \
        -Z build-std=core,alloc -Z build-std-features=compiler-builtins-mem
}

# host WORD...: the program on this machine.
host() {
    cargo build -q --release --manifest-path "$root/machines/frames/Cargo.toml" --features std --target-dir "$machines"
    "$machines/release/frames" "$@"
}

# part STEP: the line of every STEP-th frame, drawn on this machine. Where MACHINES_REFERENCE says so, WebAssembly draws it,
# which has drawn all frames just before, so that nothing need be built for it.
part() {
    if [ "${MACHINES_REFERENCE:-}" = wasm ]; then
        node "$root/machines/wasm/run.mjs" "$machines/wasm32-unknown-unknown/release/frames.wasm" "step=$1" kernel=portable
    else
        host "step=$1" kernel=portable
    fi
}

# drawn MACHINE STEP COMMAND...: runs the program, which prints a line for each kernel, and prints
# `machine, kernel: hash, frames, time, verdict`. What is the same as all frames of other machines stands in the laboratory;
# a part is drawn here, too.
drawn() {
    local machine=$1 step=$2 expected line kernel rest now then lines=0
    shift 2
    if [ "$step" = 1 ]; then
        # The frames and the hash of every machine: the program has compared with them, too.
        expected=$(sed -nE 's/.*EXPECTED: Self = Self \{ count: ([0-9]+), hash: 0x([0-9A-F_]+) \};/\1 frames, \2/p' \
            "$root/lab/src/verify/freestanding/frames.rs")
        expected=$(tr -d _ <<<"${expected,,}")
    else
        expected=$(part "$step")
        expected=${expected#*: }
    fi
    then=${EPOCHREALTIME/./}
    while IFS= read -r line; do
        now=${EPOCHREALTIME/./} line=${line%$'\r'}
        kernel=${line%%: *} rest=${line#*: }
        lines=$((lines + 1))
        if [ "$rest" = "$expected" ]; then verdict=same; else verdict=DIFFERENT wrong=1; fi
        printf '%s, %s: %s, %s, %d.%d s, %s\n' "$machine" "$kernel" "${rest##* }" "${rest%%,*}" \
            $(((now - then) / 1000000)) $(((now - then) / 100000 % 10)) "$verdict"
        then=$now
    done < <("$@" "step=$step" "${words[@]}" 2>&1 || echo "the program: failed, with status $?")
    if [ $lines = 0 ]; then
        echo "$machine: nothing was drawn"
        wrong=1
    fi
}

# spans MACHINE COMMAND...: every kernel on random spans, and the loops that have twins.
spans() {
    local machine=$1 said then=$SECONDS
    shift
    if said=$("$@" spans 2>&1); then verdict=right; else verdict=WRONG wrong=1; fi
    printf '%s, %s, %d s, %s\n' "$machine" "$said" $((SECONDS - then)) "$verdict"
}

# The step of a machine: every frame, or what the first argument says. Words that follow are the program's, such as
# kernel=portable.
step=${1:-1}
words=("${@:2}")
trap '[ $? = 0 ] && exit $wrong' EXIT
