// SPDX-License-Identifier: Apache-2.0
// The path of a particle in a step: sweepOf() finds the solid that it hits, sweepEnd() its position at the step's end after
// a reaction that left it with velocity v on a surface of velocity `carried`. Without RELIEF_SWEEP only the end of the step
// is tested, as in the paper.
struct Sweep {
    vec3 v;       // the particle's velocity
    vec3 from;    // the last point known to be free
    vec3 to;      // the end of the piece that begins there: in `hit`, or the end of the step
    float share;  // of the step, taken by this piece
    bool first;   // this piece begins where the step does
    float end;    // of this piece, as a share of the step
    Solid hit;
};

#if !defined(RELIEF_SWEEP)

Sweep sweepOf(vec3 p, vec3 v, float radius) {
    vec3 to = p + u_dt * v;
    return Sweep(v, p, to, 1.0, true, 1.0, solidOrGround(to, radius));
}

vec3 sweepEnd(Sweep sweep, vec3 carried, vec3 v, float contact, float radius) {
    return sweep.from + (sweep.share * u_dt) * v;
}

#else

uniform float u_sweep;  // the longest distance between two tests, world units

// In pieces no longer than u_sweep; a particle faster than RELIEF_SWEEP of them allow is slowed down.
Sweep sweepOf(vec3 p, vec3 v, float radius) {
    float distance = u_dt * length(v);
    float longest = float(RELIEF_SWEEP) * u_sweep;
    if (distance > longest) {
        v *= longest / distance;
        distance = longest;
    }
    float pieces = max(ceil(distance / u_sweep), 1.0);
    float share = 1.0 / pieces;
    vec3 from = p;
    vec3 to = p + (share * u_dt) * v;
    float end = share;
#if defined(RELIEF_TOUR)
    // One loop for all maps of all pieces, and a flag that ends it: a compiler turns a loop with a break into nested loops, in
    // which lanes wait for each other at every piece.
    ReliefTour tour;
    reliefEnter(tour, to, 0);
    int i = 1;
    bool going = true;
    while (going) {
        if (reliefGoesOn(tour)) {
            reliefAdvance(tour);
        }
        if (!reliefGoesOn(tour)) {
            going = i < RELIEF_SWEEP && float(i) < pieces && tour.best.distance >= 0.0 &&
                    !(aboveGround(to, radius) < 0.0);
            if (going) {
                from = to;
                end = (float(i) + 1.0) * share;
                to = p + (end * u_dt) * v;
                ++i;
                // The map that saw the last point outside most often sees this one outside.
                reliefEnter(tour, to, tour.map);
            }
        }
    }
    Solid next = orGround(solidOf(tour, to, radius), to, radius);
#else
    Solid next = solidOrGround(to, radius);
    for (int i = 1; i < RELIEF_SWEEP && float(i) < pieces && next.distance >= 0.0; ++i) {
        from = to;
        end = (float(i) + 1.0) * share;
        to = p + (end * u_dt) * v;
        next = solidOrGround(to, radius);
    }
#endif
    return Sweep(v, from, to, share, from == p, end, next);
}

// From the free point on for the piece's time. All pieces are tested against the end of the step: a particle that hit a
// moving body in its first piece is carried for the rest of it.
vec3 goneOn(Sweep sweep, vec3 carried, vec3 v) {
    vec3 from = sweep.from;
    from += sweep.first ? ((1.0 - sweep.share) * u_dt) * carried : vec3(0.0);
    return from + (sweep.share * u_dt) * v;
}

// The same for a particle that was outside: it stays outside.
vec3 goneOnOutside(Sweep sweep, vec3 carried, vec3 v, float radius) {
    vec3 to = goneOn(sweep, carried, v);
    if (aboveGround(to, radius) < 0.0 || solidFrom(to, radius, max(sweep.hit.map, 0)).distance < 0.0) {
        to = sweep.first ? sweep.from + u_dt * carried : sweep.from;
    }
    return to;
}

vec3 sweepEnd(Sweep sweep, vec3 carried, vec3 v, float contact, float radius) {
    return contact == float(RELIEF_CONTACT_CAUGHT) ? goneOn(sweep, carried, v) : goneOnOutside(sweep, carried, v, radius);
}

#endif
