// mode13h.hpp: the C interface for C++20. Codes become exceptions, lengths come with spans, a context owns its memory.
#ifndef MODE13H_HPP
#define MODE13H_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>

#include "mode13h.h"

namespace mode13h {

/// A code below 0 as an exception, with its message.
class Error : public std::runtime_error {
public:
    explicit Error(int code) : std::runtime_error(m13_message(code)), code_(code) {}
    [[nodiscard]] int code() const noexcept { return code_; }

private:
    int code_;
};

/// Throws for a code below 0.
inline int check(int code)
{
    if (code < M13_OK)
        throw Error(code);
    return code;
}

using Palette = std::array<std::uint8_t, 768>;
using Table = std::array<std::uint8_t, 65536>;

/// Working memory for textures and other effects.
class Context {
public:
    Context() : memory_(std::make_unique<Block[]>(m13_size() / sizeof(Block) + 1))
    {
        check(m13_init(memory_.get(), m13_size(), &context_));
    }
    [[nodiscard]] m13_context *get() const noexcept { return context_; }

private:
    struct alignas(16) Block {
        std::byte bytes[16];
    };
    std::unique_ptr<Block[]> memory_;
    m13_context *context_ = nullptr;
};

/// Vertices of any type. Offsets are those of offsetof; `indices` must live as long as the mesh.
struct Mesh : m13_mesh {
    template <class Vertex>
    explicit Mesh(std::span<const Vertex> vertices)
    {
        check(m13_mesh_init(this, vertices.data(), static_cast<std::uint32_t>(vertices.size()), sizeof(Vertex)));
    }

    template <class Index>
    Mesh &with(std::span<const Index> list) noexcept
    {
        static_assert(sizeof(Index) <= 4 && sizeof(Index) != 3, "8, 16 or 32 bits");
        // Without memory, an empty list would be none, which is every three vertices.
        static constexpr Index nothing{};
        indices = list.empty() ? &nothing : list.data();
        index_bits = 8 * sizeof(Index);
        index_count = static_cast<std::uint32_t>(list.size());
        return *this;
    }
};

struct Material : m13_material {
    explicit Material(std::uint32_t shading) { check(m13_material_init(this, shading)); }
};

/// A frame over the caller's bytes, which must outlive it.
class Target : public m13_target {
public:
    Target(std::span<std::uint8_t> bytes, std::uint32_t columns, std::uint32_t lines, std::size_t bytes_a_row)
    {
        check(m13_target_init(this, bytes.data(), bytes.size(), columns, lines, bytes_a_row));
    }
    Target(std::span<std::uint8_t> bytes, std::uint32_t columns, std::uint32_t lines)
        : Target(bytes, columns, lines, columns)
    {
    }
    /// A band of a frame: `rows` rows from `first_row` on.
    Target(std::span<std::uint8_t> bytes, std::uint32_t columns, std::uint32_t lines, std::size_t bytes_a_row,
           std::uint32_t first_row, std::uint32_t rows)
    {
        check(m13_target_init_band(this, bytes.data(), bytes.size(), columns, lines, bytes_a_row, first_row, rows));
    }
    /// Says that the bytes now hold these rows.
    void band(std::uint32_t first_row, std::uint32_t rows) { check(m13_target_band(this, first_row, rows)); }
    void with_depth(std::span<std::uint16_t> cells) { check(m13_target_depth(this, cells.data(), cells.size_bytes(), 16)); }
    void with_depth(std::span<std::uint32_t> cells) { check(m13_target_depth(this, cells.data(), cells.size_bytes(), 32)); }
    void clip(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1)
    {
        check(m13_target_clip(this, x0, y0, x1, y1));
    }
    void clear(std::uint8_t index) { check(m13_clear(this, index)); }
    void clear_depth() { check(m13_clear_depth(this)); }

    /// Draws a mesh of floats. Effects need a context.
    m13_stats draw(const Mesh &mesh, const Material &material, const Context *context = nullptr)
    {
        m13_stats stats{sizeof(m13_stats), 0, 0, 0, 0, 0};
        check(m13_draw(this, &mesh, &material, context != nullptr ? context->get() : nullptr, &stats));
        return stats;
    }
};

}  // namespace mode13h

#endif
