// Hook: what a surface is made of where a ray meets it. Replace it by a file user/surface.glsl of
// your own (docs/shaders.md); this one leaves everything as the scene says.
//
// Change `material`, for a pattern: its colours k_e k_a k_d k_s k_r k_t (linear, 0 or more) and
// `exponent`, the pattern of the scene already applied. Change `ns`, for a bump: the unit normal that
// light is computed with, on the side the geometry has it; it must stay of length 1.
// `surface` says where: point (world, metres), ng (unit, of the geometry), uv, and material, the
// place in the scene's list. See surface_t in surface.glsl and turner_gpu_material in shared.h.
//
// A pure function: the same place gives the same answer, whichever ray asks and how often. What
// decides the way of rays is not its own: media, Fresnel terms, and whether light passes at all (k_t
// only where the scene has it not 0). `real` is float, or double with precision=f64: write
// vec3(surface.point) for numbers that need no more.
void user_surface(inout turner_gpu_material material, inout real3 ns, surface_t surface)
{
}
