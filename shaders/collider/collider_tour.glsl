// The collider of a step as a tour: one map of one point at a time, so that each invocation goes on to the next body, or to
// the next piece of its path, as soon as a point is decided. In loops over bodies or pieces all lanes of a warp wait at each
// for the one that needs most maps. Where reliefSolid() or reliefUnion() is inside, a tour gives the same.
struct ReliefTour {
#if RELIEF_BODIES > 0
    vec3 p;
#endif
    vec3 q;           // the point, in the object space of the current body
    int left;         // bit b: body b is still to be evaluated, the lowest first
    int map;          // the next one
    int done;         // the number of the body's first map, plus how many are done
    int end;          // one past its last map
    int start;        // the first one to evaluate
    ReliefBest now;   // of this body
    ReliefBest best;  // the deepest so far, in world units; outside its distance is RELIEF_FAR_OUTSIDE
#if RELIEF_BODIES > 0
    int best_body;
#endif
};

bool reliefGoesOn(ReliefTour tour) {
    return tour.left != 0;
}

#if RELIEF_BODIES == 0

// Begins at a point; map `start` is first.
void reliefEnter(inout ReliefTour tour, vec3 p, int start) {
    tour.q = p;
    tour.left = 1;
#if defined(RELIEF_MASKS)
    tour.left = collidesWith(0) ? 1 : 0;
#endif
    tour.start = start;
    tour.map = start;
    tour.done = 0;
    tour.end = u_relief_count.x;
    tour.now = RELIEF_NO_VOTE;
    tour.best = ReliefBest(RELIEF_FAR_OUTSIDE, RELIEF_NO_CODE, -1);
}

#else

// False where the first map of a body knows a point to be outside without its texels.
bool reliefMayHold(int body, vec3 q) {
    int i = u_relief_bodies[body].maps.x;
    ivec4 info = u_relief_maps[i].info;
    vec3 p = reliefInMap(i, q);
    if (reliefIsPatches(info)) {
        vec3 roots = vec3(u_relief_maps[i].column[1].w, u_relief_maps[i].column[2].w, u_relief_maps[i].column[0].w);
        return !reliefHas(info, RELIEF_ENCLOSES) || all(greaterThanEqual(p, vec3(0.0))) && all(lessThan(p, roots));
    }
    bool looks = reliefInWindow(i, p) && (reliefInDepth(p) || !reliefHas(info, RELIEF_EMPTY_IS_OUTSIDE));
    return reliefIsCube(info) || !reliefHas(info, RELIEF_ENCLOSES) || looks;
}

void reliefEnterBody(inout ReliefTour tour) {
    int body = findLSB(tour.left);
    if (body >= 0) {
        tour.q = reliefBodyNow(body, tour.p);
        tour.start = u_relief_bodies[body].maps.x;
        tour.map = tour.start;
        tour.done = tour.start;
        tour.end = tour.start + u_relief_bodies[body].maps.y;
        tour.now = RELIEF_NO_VOTE;
    }
}

// The maps of a body have an order of their own: `start` is for a single collider.
void reliefEnter(inout ReliefTour tour, vec3 p, int start) {
    tour.p = p;
    tour.left = 0;
    for (int b = 0; b < RELIEF_BODIES; ++b) {
        bool may = u_relief_bodies[b].maps.y > 0 && reliefMayHold(b, reliefBodyNow(b, p));
#if defined(RELIEF_MASKS)
        may = may && collidesWith(b);
#endif
        tour.left |= may ? 1 << b : 0;
    }
    tour.best = ReliefBest(RELIEF_FAR_OUTSIDE, RELIEF_NO_CODE, -1);
    tour.best_body = -1;
    reliefEnterBody(tour);
}

#endif

void reliefLeaveBody(inout ReliefTour tour) {
    bool inside = tour.now.map >= 0 && tour.now.distance < 0.0;
#if RELIEF_BODIES > 0
    int body = findLSB(tour.left);
    float distance = u_relief_bodies[body].response.x * tour.now.distance;
    if (inside && distance < tour.best.distance) {
        tour.best = ReliefBest(distance, tour.now.normal, tour.now.map);
        tour.best_body = body;
    }
    tour.left &= tour.left - 1;
    reliefEnterBody(tour);
#else
    if (inside) {
        tour.best = tour.now;
    }
    tour.left = 0;
#endif
}

// Evaluates the next map.
void reliefAdvance(inout ReliefTour tour) {
    ReliefVote vote = reliefVote(tour.map, tour.q, false);
    // Of equal votes that of the first map counts, as in reliefMaps().
    if (vote.distance > tour.now.distance || (vote.distance == tour.now.distance && tour.map < tour.now.map)) {
        tour.now = ReliefBest(vote.distance, vote.normal, tour.map);
    }
    ++tour.done;
    if (tour.now.distance >= 0.0 || tour.done == tour.end) {
        reliefLeaveBody(tour);
    } else {
        tour.map = tour.done <= tour.start ? tour.done - 1 : tour.done;
    }
}

// Outside, the normal is zero and the map -1.
ReliefField reliefToured(ReliefTour tour) {
    vec3 normal = vec3(0.0);
    if (tour.best.map >= 0) {
        normal = reliefDecode(tour.best.normal);
#if RELIEF_BODIES > 0
        normal = reliefWorldNormal(tour.best_body, normal);
#endif
    }
    return ReliefField(tour.best.distance, normal, tour.best.map);
}
