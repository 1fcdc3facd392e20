// A textured triangle with the C++ header: c++ -std=c++20 triangle.cpp -lmode13h
#include <cstdio>
#include <vector>

#include "mode13h.hpp"

struct Vertex {
    float x, y, u, v;
};

int main()
{
    std::vector<std::uint8_t> pixels(320 * 200), texels(64 * 64);
    for (std::size_t i = 0; i < texels.size(); i++)
        texels[i] = static_cast<std::uint8_t>((i ^ i / 64) & 8 ? 1 : 2);
    const std::vector<Vertex> vertices{{10, 10, 0, 0}, {300, 40, 128, 0}, {40, 190, 0, 128}};
    mode13h::Target frame(pixels, 320, 200);
    mode13h::Mesh mesh{std::span<const Vertex>(vertices)};
    mesh.texture = offsetof(Vertex, u);
    mode13h::Material material(M13_FLAT);
    material.texels = texels.data();
    material.u_bits = material.v_bits = 6;
    const mode13h::Context context;
    const m13_stats stats = frame.draw(mesh, material, &context);
    std::printf("%u pixels\n", static_cast<unsigned>(stats.pixels));
    try {
        frame.draw(mesh, material);
    } catch (const mode13h::Error &error) {
        return error.code() == M13_CONTEXT ? 0 : 1;
    }
    return 1;
}
