// The way of a particle in a step: wayOf() finds what it meets, wayEnd() says where it is at the step's end after a
// reaction that left it with velocity v on a surface of velocity `carried`. Without RELIEF_SWEEP only the end of the
// step is tested, as in the paper.
struct Way {
    vec3 v;       // the velocity that it goes with
    vec3 from;    // the last point that is known to be free
    vec3 to;      // the end of the piece from there on: in `met`, or where the step ends
    float share;  // of the step, that this piece takes
    bool first;   // whether this piece begins where the step does
    float end;    // of this piece, as a share of the step
    Solid met;
};

#if !defined(RELIEF_SWEEP)

Way wayOf(vec3 p, vec3 v, float radius) {
    vec3 to = p + u_dt * v;
    return Way(v, p, to, 1.0, true, 1.0, solidOrGround(to, radius));
}

vec3 wayEnd(Way way, vec3 p, vec3 carried, vec3 v, float contact, float radius) {
    return way.from + (way.share * u_dt) * v;
}

#else

uniform float u_sweep;  // the longest way between two tests, world units

// In pieces no longer than u_sweep; what is faster than RELIEF_SWEEP of them allow is slowed down.
Way wayOf(vec3 p, vec3 v, float radius) {
    float way = u_dt * length(v);
    float longest = float(RELIEF_SWEEP) * u_sweep;
    if (way > longest) {
        v *= longest / way;
        way = longest;
    }
    float pieces = max(ceil(way / u_sweep), 1.0);
    float share = 1.0 / pieces;
    vec3 from = p;
    vec3 to = p + (share * u_dt) * v;
    float end = share;
#if defined(RELIEF_TOUR)
    // One loop for all maps of all pieces, and a flag that ends it: with a break inside a compiler makes loops within loops of
    // it, in which lanes wait for each other at every piece.
    ReliefTour tour;
    reliefEnter(tour, to, 0);
    int i = 1;
    bool going = true;
    while (going) {
        if (reliefGoesOn(tour)) {
            reliefAsk(tour);
        }
        if (!reliefGoesOn(tour)) {
            going = i < RELIEF_SWEEP && float(i) < pieces && tour.best.distance >= 0.0 &&
                    !(aboveGround(to, radius) < 0.0);
            if (going) {
                from = to;
                end = (float(i) + 1.0) * share;
                to = p + (end * u_dt) * v;
                ++i;
                // The map that saw that the last point is outside knows most often that this one is.
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
    return Way(v, from, to, share, from == p, end, next);
}

// From the free point on for the piece's time. All pieces are tested against the end of the step: what met a moving
// body in its first piece has yet to be carried for the rest of it.
vec3 goneOn(Way way, vec3 carried, vec3 v) {
    vec3 from = way.from;
    from += way.first ? ((1.0 - way.share) * u_dt) * carried : vec3(0.0);
    return from + (way.share * u_dt) * v;
}

// The same of what was outside: it stays there, whatever lies beside.
vec3 goneOnOutside(Way way, vec3 carried, vec3 v, float radius) {
    vec3 to = goneOn(way, carried, v);
    if (aboveGround(to, radius) < 0.0 || solidFrom(to, radius, max(way.met.map, 0)).distance < 0.0) {
        to = way.first ? way.from + u_dt * carried : way.from;
    }
    return to;
}

#if !defined(RELIEF_VERLET)

vec3 wayEnd(Way way, vec3 p, vec3 carried, vec3 v, float contact, float radius) {
    return contact == RELIEF_CAUGHT ? goneOn(way, carried, v) : goneOnOutside(way, carried, v, radius);
}

#else

// The velocity of Verlet is the way of the last step, so after a reaction the whole way must be gone, and tested: from
// p, where the surface has carried the particle, with the velocity relative to it, up to the first piece that would
// end inside. What is not free yet may first come out.
vec3 sweptFrom(vec3 p, vec3 v, bool free, float radius) {
    float pieces = clamp(ceil(u_dt * length(v) / u_sweep), 1.0, float(RELIEF_SWEEP));
    vec3 reached = p;
    for (int i = 1; i <= RELIEF_SWEEP && float(i) <= pieces; ++i) {
        vec3 q = p + (float(i) / pieces * u_dt) * v;
        bool inside = solidOrGround(q, radius).distance < 0.0;
        if (inside && free) {
            break;
        }
        free = free || !inside;
        reached = q;
    }
    return reached;
}

vec3 wayEnd(Way way, vec3 p, vec3 carried, vec3 v, float contact, float radius) {
    return contact < RELIEF_STOPPED
               ? sweptFrom(p + u_dt * carried, v - carried, contact == RELIEF_COLLIDED, radius)
               : goneOnOutside(way, carried, v, radius);
}

#endif

#endif
