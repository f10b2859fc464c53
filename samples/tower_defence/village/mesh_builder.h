// Builds one model from charts: grids, planar polygons, discs and blades, in metres. finish() packs
// the charts into one square burn atlas, computes normals and welds the corners. Geometry can only
// be added.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "model.h"

namespace village {

// Faces of a box to build, in the bit order +x -x +y -y +z -z.
using FaceMask = unsigned;
constexpr FaceMask kAllFaces = 0b111111;
constexpr FaceMask kOpenBelow = 0b111011;
constexpr FaceMask kOpenBelowAndBehind = 0b111010;
constexpr FaceMask kSidesOnly = 0b110011;
constexpr FaceMask kFrontAndSides = 0b110010;
constexpr FaceMask kFrontAndTop = 0b001010;
constexpr FaceMask kFrontOnly = 0b000010;

class MeshBuilder {
 public:
    // burnTexels: side of the burn map that the gutters fit.
    MeshBuilder(std::string name, uint32_t modelSeed, int burnTexels);

    // State of the following shapes; may change at any time.
    Frame frame;          // transform of the shapes
    Vec3 tint{1, 1, 1};   // linear albedo
    float crease = 0.6f;  // cosine below which an edge stays hard
    uint32_t seed;        // advances with every random draw
    bool fine = false;    // fine parts are hidden from afar
    // Sway in the wind: grows with the square of the height above the root, or of the depth below
    // it for hanging parts.
    struct Sway {
        float root = 0;   // m, model space
        float yield = 0;  // m, sway at 1 m from the root in a wind of 1 m/s
    } sway;

    void use(Texture texture, Material material, Vec3 newTint, float glow = 0);
    float random();                       // [0, 1]
    float random(float low, float high);  // [low, high]

    // One chart of width x height metres. place(u, v) returns the points, u and v in [0, 1].
    // Outward is du x dv.
    void grid(int columns, int rows, float width, float height,
              const std::function<Vec3(float, float)>& place);
    // Convex and counter-clockwise; the texture's V runs along the grain.
    void polygon(std::span<const Vec3> points, Vec3 grain);
    void quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 grain);
    void triangle(Vec3 a, Vec3 b, Vec3 c, Vec3 grain);
    // A box that stands on `base`. Its top is scaled by taper and shifted by lean along x.
    void box(Vec3 base, Vec3 size, float taper = 1, Vec3 grain = {0, 1, 0},
             FaceMask faces = kOpenBelow, float lean = 0);
    // A box from a to b with its grain along it.
    void beam(Vec3 a, Vec3 b, float width, float depth, float taper = 1,
              FaceMask faces = kOpenBelow);
    void disc(Vec3 centre, Vec3 axisX, Vec3 axisY, float radius, int sides);
    // ragged: m, how far the end rings are torn along the tube.
    void tube(const std::vector<Vec3>& path, const std::vector<float>& radii, int sides,
              bool capped = true, float ragged = 0);
    // Rotates (radius, y) around the y axis; upward profiles face outward. ragged: m, random offset
    // of the points.
    void lathe(const std::vector<Vec2>& profile, int sides, float ragged = 0, float phase = 0);
    // A latitude-longitude lump for foliage, sacks and boilers.
    void blob(Vec3 centre, Vec3 radius, int columns, int rows, float roughness);
    // A fan of leaning blades, one triangle each: grass, wheat, reeds, straw hands.
    void blades(Vec3 base, int count, float height, float width, float spread,
                Vec3 axis = {0, 1, 0});

    Model finish();

 private:
    struct Corner {
        Vertex vertex;  // uv in metres within its chart until packing
        int chart;
        int group;  // corners share normals only within a group
        float crease;
        bool fine;
    };
    struct Chart {
        float width, height;  // m
        float x = 0, y = 0;   // m, position in the atlas
    };

    int addChart(float width, float height);
    void addTriangle(Vec3 a, Vec3 b, Vec3 c, Vec2 uvA, Vec2 uvB, Vec2 uvC, int chart);
    bool placeCharts(std::span<const int> order, float side);
    void packCharts();
    void putFineLast();
    void makeNormals();
    void weld();

    Model model_;
    std::vector<Corner> corners_;
    std::vector<Chart> charts_;
    Texture texture_ = Texture::kPlank;
    Material material_ = Material::kWood;
    float glow_ = 0;
    int group_ = 0;
    bool sideways_ = false;  // rotates a grid's chart, so that masonry courses stay level
};

}  // namespace village
