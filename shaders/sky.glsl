// The light of all pictures.
const vec3 SUN_COLOR = vec3(1.02, 0.97, 0.88);
const vec3 SKY_COLOR = vec3(0.40, 0.46, 0.56);
const vec3 FLOOR_COLOR = vec3(0.25, 0.26, 0.28);  // what comes back from below
