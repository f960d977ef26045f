// Is a point in the collider? Where it is, the same answer as reliefEvaluate's; where it is not, the first map
// that sees it outside ends the question, so that most points cost one fetch however many maps there are.
// (Rule 2 never turns a vote ≥ 0 into one below.) Needs collider.glsl.
ReliefField reliefSolid(vec3 p) {
    ReliefField best = ReliefField(RELIEF_FAR_INSIDE, vec3(0.0), -1);
    for (int i = 0; i < u_relief_count.x && best.distance < 0.0; ++i) {
        vec3 in_map = vec3(reliefRow(u_relief_maps[i].row[0], p), reliefRow(u_relief_maps[i].row[1], p),
                           reliefRow(u_relief_maps[i].row[2], p));
        ivec4 rect = u_relief_maps[i].rect;
        ivec4 info = u_relief_maps[i].info;
        if (info.y == RELIEF_CUBE8) {
            reliefVoteCube(best, i, in_map, rect, info);
        } else {
            reliefVoteOrthographic(best, i, in_map, rect, info);
        }
    }
    return best;
}
