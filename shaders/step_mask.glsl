// Which bodies the particle of this invocation collides with. Without RELIEF_MASKS with all, at no cost.
#if defined(RELIEF_MASKS)

uniform int u_collides[RELIEF_TYPES];  // ParticleType::collides
int g_collides;                        // that of this particle

bool collidesWith(int body) {  // RELIEF_GROUND: the floor
    return ((g_collides >> body) & 1) != 0;
}

#endif
