// The device's acceleration structures (VK_KHR_ray_query). Triangles and boxes are offered as
// candidates and intersected by our own routines, so that both traversals see the same hits. One
// query variable and one place that proceeds: lavapipe inlines the walk there.

layout(set = 0, binding = TURNER_BINDING_TLAS) uniform accelerationStructureEXT tlas;

// The device drops triangles it finds no nearer than one confirmed before, by its own t, so that of
// two at the same place it decides which is seen. A second walk, over a sliver about the hit and
// without confirming, offers them all to our own tie rule.
const float SLIVER = 1e-5;

void traverse(inout search_t search, ray_t ray)
{
    instance_array instances = instance_array(scene.instances);
    shear_t shear = shear_of(ray.direction);
    uint sheared = 0u; // the instance that `shear` belongs to; 0, the world, has the identity
    float t_min = 0.0, t_max = search.hit.t;
    rayQueryEXT query;
    for (uint walk = 0; walk < (NEEDS_ANY(TURNER_NEEDS_TRIANGLES) ? 2 : 1); walk++) {
        rayQueryInitializeEXT(query, tlas, gl_RayFlagsNoOpaqueEXT, 0xff, ray.origin, t_min,
                              ray.direction, t_max);
        for (uint visit = 0; visit < scene.max_visits && rayQueryProceedEXT(query); visit++) {
            bool triangle = rayQueryGetIntersectionTypeEXT(query, false) ==
                            gl_RayQueryCandidateIntersectionTriangleEXT;
            uint instance = rayQueryGetIntersectionInstanceCustomIndexEXT(query, false);
            uint first = triangle ? instances.at[instance].triangles : instances.at[instance].boxes;
            uint index = first + rayQueryGetIntersectionPrimitiveIndexEXT(query, false);
            real3 origin = ray.origin, direction = ray.direction;
            uint override_material = TURNER_NO_INDEX;
            if (NEEDS_ANY(TURNER_NEEDS_INSTANCES)) {
                real[12] to_group = to_group_of(instance);
                origin = transform_point(to_group, ray.origin);
                direction = transform_vector(to_group, ray.direction);
                override_material = instances.at[instance].material;
                if (instance != sheared) {
                    shear = shear_of(direction);
                    sheared = instance;
                }
            }
            float before = search.hit.t;
            intersect_primitive(search, primitive_of(index), index,
                                instance, override_material, origin, direction, shear);
            if (search.blocked)
                return;
            if (walk == 0u && search.hit.t < before) {
                if (triangle)
                    rayQueryConfirmIntersectionEXT(query);
                else
                    rayQueryGenerateIntersectionEXT(query, search.hit.t);
            }
        }
        if (!search.found || (search.hit.id >> TURNER_KIND_SHIFT) != TURNER_KIND_TRIANGLE)
            return;
        t_min = search.hit.t * (1.0 - SLIVER);
        t_max = search.hit.t * (1.0 + SLIVER);
    }
}
