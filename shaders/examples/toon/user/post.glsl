// As in a comic: brightness in a few steps, and the paper's colour in the light.

//!PARAM steps int 4 2 16 "how many shades"
//!PARAM look choice shades shades|ink "keep the colours, or draw with ink on paper"
//!PARAM paper color 0.95,0.9,0.75 "the paper, for ink"

vec3 user_post(vec3 color, vec2 position, vec2 size)
{
    float brightness = dot(color, vec3(0.2126, 0.7152, 0.0722)); // Rec. 709
    float level = min((floor(brightness * float(steps)) + 0.5) / float(steps), 1.0);
    if (look == look_ink)
        return paper * level;
    return brightness > 0.0 ? color * (level / brightness) : color;
}
