// The colour that a thin clear film gives to mirrored light: its upper and lower side mirror each a part, and what
// the lower one mirrors comes later, by more waves for blue than for red.
// vec3 film_color(float thickness, float facing): for nanometres, and the cosine between normal and look.

const float FILM_INDEX = 1.56;    // of light in guanine's layers and the cytoplasm between them, about
const vec3 FILM_WAVELENGTHS = vec3(620.0, 540.0, 455.0);    // nanometres, of red, green and blue

vec3 film_color(float thickness, float facing) {
    float inside = sqrt(1.0 - (1.0 - facing * facing) / (FILM_INDEX * FILM_INDEX));     // Snell's law
    vec3 later = 2.0 * FILM_INDEX * thickness * inside / FILM_WAVELENGTHS;
    return 0.5 + 0.5 * cos(6.2831853 * later);
}
