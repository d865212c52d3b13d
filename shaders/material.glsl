// What a surface is made of, at a point: the scene's material with its pattern applied.

turner_gpu_material material_at(surface_t surface)
{
    turner_gpu_material material = material_of(surface.material);
    real2 uv = surface.uv * material.uv_scale;
    vec3 pattern = vec3(1.0);
    if (NEEDS_ANY(TURNER_NEEDS_CHECKER) && material.pattern == TURNER_PATTERN_KIND_CHECKER) {
        // parity without overflow, far out on a plane too
        real parity = floor(uv.x) + floor(uv.y);
        pattern = parity - 2.0 * floor(0.5 * parity) == 0.0 ? material.checker0 : material.checker1;
    }
    if (NEEDS_ANY(TURNER_NEEDS_IMAGES) && material.pattern == TURNER_PATTERN_KIND_IMAGE)
        pattern = sample_image(material.image, vec2(uv), false);
    material.k_d *= pattern;
    material.k_a *= pattern;
    return material;
}
