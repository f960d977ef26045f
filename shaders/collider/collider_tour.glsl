// SPDX-License-Identifier: Apache-2.0
// Evaluates a single collider in a step as a tour: one map of one point per iteration, so that each invocation
// continues with the next piece of its path as soon as a point is decided. In a loop over pieces, all lanes of a warp
// would wait for the lane that needs most maps. If reliefSolid() is inside, a tour gives the same result.
struct ReliefTour {
    vec3 p;
    bool going;
    int map;          // next map
    int done;         // number of maps evaluated
    int start;        // first map to evaluate
    ReliefBest best;  // deepest vote so far; if outside, its distance is RELIEF_FAR_OUTSIDE
};

bool reliefGoesOn(ReliefTour tour) {
    return tour.going;
}

// Starts at a point with map `start`.
void reliefEnter(inout ReliefTour tour, vec3 p, int start) {
    tour.p = p;
    tour.going = true;
#if defined(RELIEF_MASKS)
    tour.going = collidesWith(1);
#endif
    tour.map = start;
    tour.done = 0;
    tour.start = start;
    tour.best = RELIEF_NO_VOTE;
    if (!tour.going) {
        tour.best.distance = RELIEF_FAR_OUTSIDE;
    }
}

// Evaluates the next map.
void reliefAdvance(inout ReliefTour tour) {
    ReliefVote vote = reliefVote(tour.map, tour.p, false);
    // Ties go to the first map, as in reliefMaps().
    if (vote.distance > tour.best.distance || (vote.distance == tour.best.distance && tour.map < tour.best.map)) {
        tour.best = ReliefBest(vote.distance, vote.normal, tour.map);
    }
    ++tour.done;
    tour.going = tour.best.distance < 0.0 && tour.done < u_relief_count.x;
    if (tour.going) {
        tour.map = tour.done <= tour.start ? tour.done - 1 : tour.done;
    } else if (tour.best.map < 0 || tour.best.distance >= 0.0) {
        tour.best = ReliefBest(RELIEF_FAR_OUTSIDE, RELIEF_NO_CODE, -1);
    }
}

// Returns the result; outside, the normal is zero and the map -1.
ReliefField reliefToured(ReliefTour tour) {
    vec3 normal = vec3(0.0);
    if (tour.best.map >= 0) {
        normal = reliefDecode(tour.best.normal);
    }
    return ReliefField(tour.best.distance, normal, tour.best.map);
}
