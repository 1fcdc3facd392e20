# What the scripts machines/*/run share; they source it.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# One place for all: core and alloc are built once per target and reused.
machines=${MACHINES_TARGET:-$root/target/machines}
mkdir -p "$machines"
wrong=0

# needs PACKAGE...: installs missing packages.
needs() {
    local package missing=()
    for package; do
        dpkg-query -W -f '${Status}\n' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
    done
    # Another machine may be installing at the same time.
    [ ${#missing[@]} = 0 ] ||
        apt-get -o DPkg::Lock::Timeout=600 install -q -y --no-install-recommends "${missing[@]}" >&2
}

# compiled TARGET [RUSTFLAGS...]: builds the program for a target with only core and alloc. Debian's compiler includes
# their source; rustup's has it as the component rust-src.
compiled() {
    local target=$1
    shift
    needs rustc-web cargo-web rust-web-src rust-web-llvm
    # rust-lld is the linker that belongs to this compiler, and links for all of these processors.
    needs "$(basename "$(readlink /usr/bin/rust-lld)")"
    local flags="$* -C linker=rust-lld -C linker-flavor=${linker:-ld.lld} -C relocation-model=${relocation:-static}"
    RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 RUSTFLAGS=$flags /usr/bin/cargo build -q --release \
        --manifest-path "$root/machines/frames/Cargo.toml" --target-dir "$machines" --target "$target" \
        -Z build-std=core,alloc -Z build-std-features=compiler-builtins-mem
}

# host WORD...: runs the program on this machine.
host() {
    cargo build -q --release --manifest-path "$root/machines/frames/Cargo.toml" --features std --target-dir "$machines"
    "$machines/release/frames" "$@"
}

# drawn MACHINE STEP COMMAND...: runs the program, which prints a line for each kernel, and prints
# `machine, kernel: hash, frames, time, verdict`. The program knows the hash of each frame on other machines. For the
# first frame that differs, it finds the first differing pixel by comparing with this machine's own frame.
drawn() {
    local machine=$1 step=$2 line kernel rest now then verdict name lines=0
    shift 2
    then=${EPOCHREALTIME/./}
    while IFS= read -r line; do
        now=${EPOCHREALTIME/./} line=${line%$'\r'}
        kernel=${line%%: *} rest=${line#*: }
        lines=$((lines + 1))
        # N frames, HASH, VERDICT
        verdict=${rest##*, }
        [ "$verdict" = same ] || wrong=1
        rest=${rest%, *}
        printf '%s, %s: %s, %s, %d.%d s, %s\n' "$machine" "$kernel" "${rest##* }" "${rest%%,*}" \
            $(((now - then) / 1000000)) $(((now - then) / 100000 % 10)) "$verdict"
        if [[ "$verdict" == *DIFFERENT:* ]]; then
            name=${verdict#*: }
            pixel "${name%% *}" "$kernel" "$@"
        fi
        then=${EPOCHREALTIME/./}
    done < <("$@" "step=$step" "${words[@]}" 2>&1 || { status=$?; [ $status = 1 ] || echo "the program: failed, with status $status"; })
    if [ $lines = 0 ]; then
        echo "$machine: nothing was drawn"
        wrong=1
    fi
}

# pixel FRAME KERNEL COMMAND...: the first pixel of a frame that the program draws differently from this machine.
pixel() {
    local frame=$1 kernel=$2
    shift 2
    paste -d ' ' <(host "frame=$frame" kernel=portable) <("$@" "frame=$frame" "kernel=${kernel// (*/}") | awk -v frame="$frame" '
        $1 != $2 {
            for (x = 0; substr($1, 2 * x + 1, 2) == substr($2, 2 * x + 1, 2); x++) ;
            printf "    %s: pixel (%d, %d) is 0x%s, not 0x%s\n", frame, x, NR - 1, substr($2, 2 * x + 1, 2), substr($1, 2 * x + 1, 2)
            exit
        }'
}

# loops MACHINE COMMAND...: checks every pixel loop against its definition, with every kernel.
loops() {
    local machine=$1 said then=$SECONDS verdict
    shift
    if said=$("$@" loops 2>&1); then verdict=right; else verdict=WRONG wrong=1; fi
    printf '%s, %s, %d s, %s\n' "$machine" "$(head -n 1 <<<"$said")" $((SECONDS - then)) "$verdict"
    tail -n +2 <<<"$said"
}

# The step of a machine: every frame, or what the first argument says. The remaining words are the program's, such as
# kernel=portable.
step=${1:-1}
words=("${@:2}")
trap '[ $? = 0 ] && exit $wrong' EXIT
