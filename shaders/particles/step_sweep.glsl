// SPDX-License-Identifier: Apache-2.0
// The path of a particle in a step. sweepOf() finds the solid that it hits. sweepEnd() returns its position at the end
// of the step after a reaction with resulting velocity v on a surface with velocity `carried`. Without RELIEF_SWEEP
// only the end of the step is tested, as in the paper.
struct Sweep {
    vec3 v;       // velocity of the particle
    vec3 from;    // last point known to be free
    vec3 to;      // end of the piece that starts there: inside `hit`, or the end of the step
    float share;  // fraction of the step taken by this piece
    bool first;   // this piece starts at the start of the step
    float end;    // end of this piece, as a fraction of the step
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

uniform float u_sweep;  // maximum distance between two tests, world units

// Tests pieces of at most u_sweep; a particle that moves more than RELIEF_SWEEP pieces is slowed down.
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
    // A single loop over all maps of all pieces, ended by a flag: compilers turn a loop with a break into nested loops,
    // in which lanes wait for each other at every piece.
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
                // The map that classified the last point as outside usually also classifies this point as outside.
                reliefEnter(tour, to, tour.map);
            }
        }
    }
    Solid next = orGround(solidOf(tour, to, radius), to, radius);
#else
    Solid next;
    int i = 0;
    bool going = true;
    while (going) {
        next = solidOrGround(to, radius);
        ++i;
        going = i < RELIEF_SWEEP && float(i) < pieces && next.distance >= 0.0;
        if (going) {
            from = to;
            end = (float(i) + 1.0) * share;
            to = p + (end * u_dt) * v;
        }
    }
#endif
    return Sweep(v, from, to, share, from == p, end, next);
}

// Continues from the free point for the duration of the piece. All pieces are tested against the bodies at the end of
// the step: a particle that hits a moving body in its first piece is carried for the rest of the step.
vec3 continued(Sweep sweep, vec3 carried, vec3 v) {
    vec3 from = sweep.from;
    from += sweep.first ? ((1.0 - sweep.share) * u_dt) * carried : vec3(0.0);
    return from + (sweep.share * u_dt) * v;
}

// Like continued(), for a particle that was outside: it stays outside.
vec3 continuedOutside(Sweep sweep, vec3 carried, vec3 v, float radius) {
    vec3 to = continued(sweep, carried, v);
    if (aboveGround(to, radius) < 0.0 || solidFrom(to, radius, max(sweep.hit.map, 0)).distance < 0.0) {
        to = sweep.first ? sweep.from + u_dt * carried : sweep.from;
    }
    return to;
}

vec3 sweepEnd(Sweep sweep, vec3 carried, vec3 v, float contact, float radius) {
    return contact == float(RELIEF_CONTACT_CAUGHT) ? continued(sweep, carried, v)
                                                   : continuedOutside(sweep, carried, v, radius);
}

#endif
