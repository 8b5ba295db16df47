# awk -f tests/plain.awk -f tests/features.awk src/dem.h: lines outside the home of a feature that name it. The home of
# a feature is the files in src/ that are about it. Its names are private: functions, types and constants (after demi_
# or DEMI_), and members of structs. A line counts once for each feature that it names. These do not count: comments
# and texts, the public half, the declarations of data, and the table of features. Prints for each feature the number
# of lines, and the files with their numbers; with -v show=cell, the lines of that feature. Ends with code 1 if there
# are more lines than `cap`.
BEGIN {
    cap = 385; passed = "^(api/.*|core/(layout|state)[.]h|run/features[.]h)$"
    feature("feeds and outlets", "scene/feed.h",
        "(feeds?|outlets?|FEED|OUTLET)(_.*)?|feeder|no_(feed|outlet)|look_(feeds|outlets)|ZONED|ZONES|AGED",
        "feeds|feed_count|outlets|outlet_count|zones|zoned|aged|born")
    # not the cells of the search grid, of a wall and of fields
    feature("cell", "body/cell.h run/stress.h",
        "cell_(axes|bars|book|carry|choose|drag|flow|lead|look|map|move|on|refuse|rows|slid|slides|speed|stiffens?" \
        "|upright|whole)|strained|virial_add|(tile|look)_cells?|CELL_.*|E_CELL", "")
    reached[features] = "(^|[^a-z_])((w|m|world|domain)->|[a-z]*\\]\\.)cell[^A-Za-z0-9_]"
    feature("events", "run/events.h contact/noted.h measure/impacts.h",
        "(events?|noted|impacts?|worn|EVENT|NOTED)(_.*)?|ongoing|matched|sums|note|note_arm|notes_room" \
        "|tile_note|(leave|look)_events", "events")
    feature("joints", "impulse/joints.h impulse/joints-solved.h",
        "(joints?|rods?|nodes?|JOINT)(_.*)?|joined|no_joint|motor_sane|JOINTED", "joints|joint_count|joint_last")
    # averages on a grid and of bodies; not fields of force (demi_field_rate) and of descs (demi_field_row)
    feature("fields", "run/fields.h",
        "field|field_(branch|cells|contacts|counts|due|find|grain|next|reals|rows|squares.*|volume)|fields_.*" \
        "|(again|look|no)_field|means_add|(FIELD|MEANS)(_.*)?|AVERAGED", "fields|field_count|means|averaged")
    feature("servo", "drive/servo.h", "servos?_.*|SERVO_.*", "servo")
    feature("groups", "scene/groups.h", "group_(check|find)|in_group|GROUPED", "groups|group_count|group_names")
    feature("rails", "drive/rails.h", "(rails?|RAILS?)(_.*)?", "rails|rail_count")
    # not the energy that springs gain while nothing moves, which the account calls growth
    feature("growth", "drive/growth.h", "growth_on|radii_grow|member_grow|body_resize|(leave|look)_growth", "")
    reached[features] = "(->|\\.)grown[^A-Za-z0-9_]|([^a-z_]c->|desc(->|\\.))growth(_user|_interval)?[^A-Za-z0-9_]"
    feature("outputs", "file/output.h", "(outputs?|OUTPUTS?)(_.*)?|written|visit_outputs",
        "outputs|output_count|output_last|outputs_look|outputs_again|written|written_count")
    feature("replay", "replay/replay.h replay/viewer.h", "(replay|films?|REPLAY|FILM)(_.*)?", "films|films_look")
    feature("belts", "surface/motions.h drive/steering.h", "glide_at|steer|steer_tile|wall_(before|after)", "glides?")
}
/^#include "/ { split($0, part, "\""); room[++rooms] = part[2] }
END {
    path = FILENAME; sub(/[^\/]*$/, "", path)
    for (r = 1; r <= rooms; r++) if (room[r] !~ passed) read_room(r)
    for (f = 1; f <= features; f++) printf "%-18s%4d lines:%s\n", title[f], lines[f], where[f]
    printf "lines that name a feature outside its home: %d, at most %d\n", total, cap
    exit total > cap
}
# members: those of structs, as far as no other feature has members of this name; or nothing
function feature(name, rooms_of_it, private_names, members) {
    title[++features] = name; home[features] = " " rooms_of_it " "
    names[features] = "(^|[^A-Za-z0-9_])(demi_|DEMI_)(" private_names ")[^A-Za-z0-9_]"
    reached[features] = "(->|\\.)(" members ")[^A-Za-z0-9_]"
}
function read_room(r,   line, f, count) {
    while ((getline line < (path room[r])) > 0) {
        line = plain(line) " "
        for (f = 1; f <= features; f++)
            if (!index(home[f], " " room[r] " ") && (line ~ names[f] || line ~ reached[f])) {
                count[f]++
                if (show == title[f]) print "src/" room[r] ": " line
            }
    }
    close(path room[r]); comment = 0
    for (f in count) { lines[f] += count[f]; total += count[f]; where[f] = where[f] " " room[r] " " count[f] }
}
