/* made from dem.h by tests/refused.awk */
static const refused_field refused_fields[] = {
    {"dem_material_desc", "density", offsetof(dem_material_desc, density), FIELD_REAL, sizeof(((dem_material_desc *)0)->density)},
    {"dem_material_desc", "young", offsetof(dem_material_desc, young), FIELD_REAL, sizeof(((dem_material_desc *)0)->young)},
    {"dem_material_desc", "poisson", offsetof(dem_material_desc, poisson), FIELD_REAL, sizeof(((dem_material_desc *)0)->poisson)},
    {"dem_material_desc", "restitution", offsetof(dem_material_desc, restitution), FIELD_REAL, sizeof(((dem_material_desc *)0)->restitution)},
    {"dem_material_desc", "friction", offsetof(dem_material_desc, friction), FIELD_REAL, sizeof(((dem_material_desc *)0)->friction)},
    {"dem_material_desc", "friction_static", offsetof(dem_material_desc, friction_static), FIELD_REAL, sizeof(((dem_material_desc *)0)->friction_static)},
    {"dem_material_desc", "rolling_friction", offsetof(dem_material_desc, rolling_friction), FIELD_REAL, sizeof(((dem_material_desc *)0)->rolling_friction)},
    {"dem_material_desc", "stiffness", offsetof(dem_material_desc, stiffness), FIELD_REAL, sizeof(((dem_material_desc *)0)->stiffness)},
    {"dem_material_desc", "stiffness_ratio", offsetof(dem_material_desc, stiffness_ratio), FIELD_REAL, sizeof(((dem_material_desc *)0)->stiffness_ratio)},
    {"dem_material_desc", "stiffness_unloading", offsetof(dem_material_desc, stiffness_unloading), FIELD_REAL, sizeof(((dem_material_desc *)0)->stiffness_unloading)},
    {"dem_material_desc", "stiffness_adhesion", offsetof(dem_material_desc, stiffness_adhesion), FIELD_REAL, sizeof(((dem_material_desc *)0)->stiffness_adhesion)},
    {"dem_pair", "young_eff", offsetof(dem_pair, young_eff), FIELD_REAL, sizeof(((dem_pair *)0)->young_eff)},
    {"dem_pair", "shear_eff", offsetof(dem_pair, shear_eff), FIELD_REAL, sizeof(((dem_pair *)0)->shear_eff)},
    {"dem_pair", "restitution", offsetof(dem_pair, restitution), FIELD_REAL, sizeof(((dem_pair *)0)->restitution)},
    {"dem_pair", "friction", offsetof(dem_pair, friction), FIELD_REAL, sizeof(((dem_pair *)0)->friction)},
    {"dem_pair", "friction_static", offsetof(dem_pair, friction_static), FIELD_REAL, sizeof(((dem_pair *)0)->friction_static)},
    {"dem_pair", "rolling_friction", offsetof(dem_pair, rolling_friction), FIELD_REAL, sizeof(((dem_pair *)0)->rolling_friction)},
    {"dem_pair", "stiffness", offsetof(dem_pair, stiffness), FIELD_REAL, sizeof(((dem_pair *)0)->stiffness)},
    {"dem_pair", "stiffness_ratio", offsetof(dem_pair, stiffness_ratio), FIELD_REAL, sizeof(((dem_pair *)0)->stiffness_ratio)},
    {"dem_pair", "tangent_damping", offsetof(dem_pair, tangent_damping), FIELD_REAL, sizeof(((dem_pair *)0)->tangent_damping)},
    {"dem_pair", "normal_damping", offsetof(dem_pair, normal_damping), FIELD_REAL, sizeof(((dem_pair *)0)->normal_damping)},
    {"dem_pair", "spinning_friction", offsetof(dem_pair, spinning_friction), FIELD_REAL, sizeof(((dem_pair *)0)->spinning_friction)},
    {"dem_pair", "cohesion", offsetof(dem_pair, cohesion), FIELD_REAL, sizeof(((dem_pair *)0)->cohesion)},
    {"dem_pair", "compliance", offsetof(dem_pair, compliance), FIELD_REAL, sizeof(((dem_pair *)0)->compliance)},
    {"dem_pair", "stiffness_adhesion", offsetof(dem_pair, stiffness_adhesion), FIELD_REAL, sizeof(((dem_pair *)0)->stiffness_adhesion)},
    {"dem_pair", "ignored", offsetof(dem_pair, ignored), FIELD_INT, sizeof(((dem_pair *)0)->ignored)},
    {"dem_sizes", "kind", offsetof(dem_sizes, kind), FIELD_INT, sizeof(((dem_sizes *)0)->kind)},
    {"dem_sizes", "by_count", offsetof(dem_sizes, by_count), FIELD_INT, sizeof(((dem_sizes *)0)->by_count)},
    {"dem_sizes", "min", offsetof(dem_sizes, min), FIELD_REAL, sizeof(((dem_sizes *)0)->min)},
    {"dem_sizes", "max", offsetof(dem_sizes, max), FIELD_REAL, sizeof(((dem_sizes *)0)->max)},
    {"dem_sizes", "median", offsetof(dem_sizes, median), FIELD_REAL, sizeof(((dem_sizes *)0)->median)},
    {"dem_sizes", "spread", offsetof(dem_sizes, spread), FIELD_DOUBLE, sizeof(((dem_sizes *)0)->spread)},
    {"dem_sizes", "scale", offsetof(dem_sizes, scale), FIELD_REAL, sizeof(((dem_sizes *)0)->scale)},
    {"dem_sizes", "modulus", offsetof(dem_sizes, modulus), FIELD_DOUBLE, sizeof(((dem_sizes *)0)->modulus)},
    {"dem_sizes", "count", offsetof(dem_sizes, count), FIELD_INT, sizeof(((dem_sizes *)0)->count)},
    {"dem_sizes", "radius", offsetof(dem_sizes, radius), FIELD_REAL, sizeof(((dem_sizes *)0)->radius)},
    {"dem_sizes", "passing", offsetof(dem_sizes, passing), FIELD_DOUBLE, sizeof(((dem_sizes *)0)->passing)},
    {"dem_sizes", "deviation", offsetof(dem_sizes, deviation), FIELD_REAL, sizeof(((dem_sizes *)0)->deviation)},
    {"dem_selection", "group", offsetof(dem_selection, group), FIELD_INT, sizeof(((dem_selection *)0)->group)},
    {"dem_selection", "material", offsetof(dem_selection, material), FIELD_INT, sizeof(((dem_selection *)0)->material)},
    {"dem_selection", "shape", offsetof(dem_selection, shape), FIELD_INT, sizeof(((dem_selection *)0)->shape)},
    {"dem_selection", "radius_min", offsetof(dem_selection, radius_min), FIELD_REAL, sizeof(((dem_selection *)0)->radius_min)},
    {"dem_selection", "radius_max", offsetof(dem_selection, radius_max), FIELD_REAL, sizeof(((dem_selection *)0)->radius_max)},
    {"dem_selection", "region", offsetof(dem_selection, region), FIELD_POINTER, sizeof(((dem_selection *)0)->region)},
    {"dem_selection", "count", offsetof(dem_selection, count), FIELD_INT, sizeof(((dem_selection *)0)->count)},
    {"dem_selection", "bodies", offsetof(dem_selection, bodies), FIELD_POINTER, sizeof(((dem_selection *)0)->bodies)},
    {"dem_cluster_desc", "count", offsetof(dem_cluster_desc, count), FIELD_INT, sizeof(((dem_cluster_desc *)0)->count)},
    {"dem_cluster_desc", "positions", offsetof(dem_cluster_desc, positions), FIELD_POINTER, sizeof(((dem_cluster_desc *)0)->positions)},
    {"dem_cluster_desc", "radii", offsetof(dem_cluster_desc, radii), FIELD_POINTER, sizeof(((dem_cluster_desc *)0)->radii)},
    {"dem_cluster_desc", "radius", offsetof(dem_cluster_desc, radius), FIELD_REAL, sizeof(((dem_cluster_desc *)0)->radius)},
    {"dem_cluster_desc", "mass", offsetof(dem_cluster_desc, mass), FIELD_INT, sizeof(((dem_cluster_desc *)0)->mass)},
    {"dem_cluster_desc", "rays", offsetof(dem_cluster_desc, rays), FIELD_INT, sizeof(((dem_cluster_desc *)0)->rays)},
    {"dem_cluster_desc", "volume", offsetof(dem_cluster_desc, volume), FIELD_REAL, sizeof(((dem_cluster_desc *)0)->volume)},
    {"dem_cluster_desc", "centre", offsetof(dem_cluster_desc, centre), FIELD_REAL, sizeof(((dem_cluster_desc *)0)->centre)},
    {"dem_cluster_desc", "inertia", offsetof(dem_cluster_desc, inertia), FIELD_REAL, sizeof(((dem_cluster_desc *)0)->inertia)},
    {"dem_shape", "id", offsetof(dem_shape, id), FIELD_INT, sizeof(((dem_shape *)0)->id)},
    {"dem_profile", "vertex_count", offsetof(dem_profile, vertex_count), FIELD_INT, sizeof(((dem_profile *)0)->vertex_count)},
    {"dem_profile", "segment_count", offsetof(dem_profile, segment_count), FIELD_INT, sizeof(((dem_profile *)0)->segment_count)},
    {"dem_profile", "vertices", offsetof(dem_profile, vertices), FIELD_POINTER, sizeof(((dem_profile *)0)->vertices)},
    {"dem_profile", "segments", offsetof(dem_profile, segments), FIELD_POINTER, sizeof(((dem_profile *)0)->segments)},
    {"dem_sieve_desc", "kind", offsetof(dem_sieve_desc, kind), FIELD_INT, sizeof(((dem_sieve_desc *)0)->kind)},
    {"dem_sieve_desc", "point", offsetof(dem_sieve_desc, point), FIELD_REAL, sizeof(((dem_sieve_desc *)0)->point)},
    {"dem_sieve_desc", "normal", offsetof(dem_sieve_desc, normal), FIELD_REAL, sizeof(((dem_sieve_desc *)0)->normal)},
    {"dem_sieve_desc", "along", offsetof(dem_sieve_desc, along), FIELD_REAL, sizeof(((dem_sieve_desc *)0)->along)},
    {"dem_sieve_desc", "aperture", offsetof(dem_sieve_desc, aperture), FIELD_REAL, sizeof(((dem_sieve_desc *)0)->aperture)},
    {"dem_sieve_desc", "bar", offsetof(dem_sieve_desc, bar), FIELD_REAL, sizeof(((dem_sieve_desc *)0)->bar)},
    {"dem_sieve_desc", "length", offsetof(dem_sieve_desc, length), FIELD_REAL, sizeof(((dem_sieve_desc *)0)->length)},
    {"dem_sieve_desc", "thickness", offsetof(dem_sieve_desc, thickness), FIELD_REAL, sizeof(((dem_sieve_desc *)0)->thickness)},
    {"dem_sieve_desc", "lift", offsetof(dem_sieve_desc, lift), FIELD_REAL, sizeof(((dem_sieve_desc *)0)->lift)},
    {"dem_sieve_desc", "staggered", offsetof(dem_sieve_desc, staggered), FIELD_INT, sizeof(((dem_sieve_desc *)0)->staggered)},
    {"dem_sieve_desc", "radius", offsetof(dem_sieve_desc, radius), FIELD_REAL, sizeof(((dem_sieve_desc *)0)->radius)},
    {"dem_sieve_desc", "model", offsetof(dem_sieve_desc, model), FIELD_INT, sizeof(((dem_sieve_desc *)0)->model)},
    {"dem_sieve_desc", "clearance", offsetof(dem_sieve_desc, clearance), FIELD_REAL, sizeof(((dem_sieve_desc *)0)->clearance)},
    {"dem_motion", "kind", offsetof(dem_motion, kind), FIELD_INT, sizeof(((dem_motion *)0)->kind)},
    {"dem_motion", "velocity", offsetof(dem_motion, velocity), FIELD_REAL, sizeof(((dem_motion *)0)->velocity)},
    {"dem_motion", "point", offsetof(dem_motion, point), FIELD_REAL, sizeof(((dem_motion *)0)->point)},
    {"dem_motion", "axis", offsetof(dem_motion, axis), FIELD_REAL, sizeof(((dem_motion *)0)->axis)},
    {"dem_motion", "speed", offsetof(dem_motion, speed), FIELD_REAL, sizeof(((dem_motion *)0)->speed)},
    {"dem_motion", "amplitude", offsetof(dem_motion, amplitude), FIELD_REAL, sizeof(((dem_motion *)0)->amplitude)},
    {"dem_motion", "frequency", offsetof(dem_motion, frequency), FIELD_REAL, sizeof(((dem_motion *)0)->frequency)},
    {"dem_motion", "phase", offsetof(dem_motion, phase), FIELD_REAL, sizeof(((dem_motion *)0)->phase)},
    {"dem_motion", "start", offsetof(dem_motion, start), FIELD_DOUBLE, sizeof(((dem_motion *)0)->start)},
    {"dem_motion", "function", offsetof(dem_motion, function), FIELD_POINTER, sizeof(((dem_motion *)0)->function)},
    {"dem_motion", "user", offsetof(dem_motion, user), FIELD_POINTER, sizeof(((dem_motion *)0)->user)},
    {"dem_motion", "ramp", offsetof(dem_motion, ramp), FIELD_DOUBLE, sizeof(((dem_motion *)0)->ramp)},
    {"dem_motion", "load", offsetof(dem_motion, load), FIELD_REAL, sizeof(((dem_motion *)0)->load)},
    {"dem_motion", "area", offsetof(dem_motion, area), FIELD_REAL, sizeof(((dem_motion *)0)->area)},
    {"dem_motion", "travel", offsetof(dem_motion, travel), FIELD_REAL, sizeof(((dem_motion *)0)->travel)},
    {"dem_motion", "table", offsetof(dem_motion, table), FIELD_POINTER, sizeof(((dem_motion *)0)->table)},
    {"dem_motion", "table_count", offsetof(dem_motion, table_count), FIELD_INT, sizeof(((dem_motion *)0)->table_count)},
    {"dem_motion", "table_repeats", offsetof(dem_motion, table_repeats), FIELD_INT, sizeof(((dem_motion *)0)->table_repeats)},
    {"dem_joint_desc", "kind", offsetof(dem_joint_desc, kind), FIELD_INT, sizeof(((dem_joint_desc *)0)->kind)},
    {"dem_joint_desc", "motor", offsetof(dem_joint_desc, motor), FIELD_INT, sizeof(((dem_joint_desc *)0)->motor)},
    {"dem_joint_desc", "wall", offsetof(dem_joint_desc, wall), FIELD_INT, sizeof(((dem_joint_desc *)0)->wall)},
    {"dem_joint_desc", "collide", offsetof(dem_joint_desc, collide), FIELD_INT, sizeof(((dem_joint_desc *)0)->collide)},
    {"dem_joint_desc", "point", offsetof(dem_joint_desc, point), FIELD_REAL, sizeof(((dem_joint_desc *)0)->point)},
    {"dem_joint_desc", "axis", offsetof(dem_joint_desc, axis), FIELD_REAL, sizeof(((dem_joint_desc *)0)->axis)},
    {"dem_joint_desc", "speed", offsetof(dem_joint_desc, speed), FIELD_REAL, sizeof(((dem_joint_desc *)0)->speed)},
    {"dem_joint_desc", "torque", offsetof(dem_joint_desc, torque), FIELD_REAL, sizeof(((dem_joint_desc *)0)->torque)},
    {"dem_rail_desc", "axes", offsetof(dem_rail_desc, axes), FIELD_INT, sizeof(((dem_rail_desc *)0)->axes)},
    {"dem_rail_desc", "velocity", offsetof(dem_rail_desc, velocity), FIELD_REAL, sizeof(((dem_rail_desc *)0)->velocity)},
    {"dem_rail_desc", "spin", offsetof(dem_rail_desc, spin), FIELD_REAL, sizeof(((dem_rail_desc *)0)->spin)},
    {"dem_rail_desc", "wall", offsetof(dem_rail_desc, wall), FIELD_INT, sizeof(((dem_rail_desc *)0)->wall)},
    {"dem_feed_desc", "material", offsetof(dem_feed_desc, material), FIELD_INT, sizeof(((dem_feed_desc *)0)->material)},
    {"dem_feed_desc", "class_count", offsetof(dem_feed_desc, class_count), FIELD_INT, sizeof(((dem_feed_desc *)0)->class_count)},
    {"dem_feed_desc", "radius", offsetof(dem_feed_desc, radius), FIELD_REAL, sizeof(((dem_feed_desc *)0)->radius)},
    {"dem_feed_desc", "amount", offsetof(dem_feed_desc, amount), FIELD_DOUBLE, sizeof(((dem_feed_desc *)0)->amount)},
    {"dem_feed_desc", "limited", offsetof(dem_feed_desc, limited), FIELD_INT, sizeof(((dem_feed_desc *)0)->limited)},
    {"dem_feed_desc", "by_mass", offsetof(dem_feed_desc, by_mass), FIELD_INT, sizeof(((dem_feed_desc *)0)->by_mass)},
    {"dem_feed_desc", "rate", offsetof(dem_feed_desc, rate), FIELD_DOUBLE, sizeof(((dem_feed_desc *)0)->rate)},
    {"dem_feed_desc", "start", offsetof(dem_feed_desc, start), FIELD_DOUBLE, sizeof(((dem_feed_desc *)0)->start)},
    {"dem_feed_desc", "end", offsetof(dem_feed_desc, end), FIELD_DOUBLE, sizeof(((dem_feed_desc *)0)->end)},
    {"dem_feed_desc", "box", offsetof(dem_feed_desc, box), FIELD_REAL, sizeof(((dem_feed_desc *)0)->box)},
    {"dem_feed_desc", "round", offsetof(dem_feed_desc, round), FIELD_INT, sizeof(((dem_feed_desc *)0)->round)},
    {"dem_feed_desc", "velocity", offsetof(dem_feed_desc, velocity), FIELD_REAL, sizeof(((dem_feed_desc *)0)->velocity)},
    {"dem_feed_desc", "spread", offsetof(dem_feed_desc, spread), FIELD_REAL, sizeof(((dem_feed_desc *)0)->spread)},
    {"dem_feed_desc", "inside", offsetof(dem_feed_desc, inside), FIELD_POINTER, sizeof(((dem_feed_desc *)0)->inside)},
    {"dem_feed_desc", "inside_user", offsetof(dem_feed_desc, inside_user), FIELD_POINTER, sizeof(((dem_feed_desc *)0)->inside_user)},
    {"dem_feed_desc", "materials", offsetof(dem_feed_desc, materials), FIELD_INT, sizeof(((dem_feed_desc *)0)->materials)},
    {"dem_feed_desc", "shapes", offsetof(dem_feed_desc, shapes), FIELD_INT, sizeof(((dem_feed_desc *)0)->shapes)},
    {"dem_feed_desc", "sizes", offsetof(dem_feed_desc, sizes), FIELD_POINTER, sizeof(((dem_feed_desc *)0)->sizes)},
    {"dem_outlet_desc", "frame", offsetof(dem_outlet_desc, frame), FIELD_INT, sizeof(((dem_outlet_desc *)0)->frame)},
    {"dem_outlet_desc", "box", offsetof(dem_outlet_desc, box), FIELD_REAL, sizeof(((dem_outlet_desc *)0)->box)},
    {"dem_outlet_desc", "beyond", offsetof(dem_outlet_desc, beyond), FIELD_REAL, sizeof(((dem_outlet_desc *)0)->beyond)},
    {"dem_outlet_desc", "wanted_min", offsetof(dem_outlet_desc, wanted_min), FIELD_REAL, sizeof(((dem_outlet_desc *)0)->wanted_min)},
    {"dem_outlet_desc", "wanted_max", offsetof(dem_outlet_desc, wanted_max), FIELD_REAL, sizeof(((dem_outlet_desc *)0)->wanted_max)},
    {"dem_outlet_desc", "class_count", offsetof(dem_outlet_desc, class_count), FIELD_INT, sizeof(((dem_outlet_desc *)0)->class_count)},
    {"dem_outlet_desc", "radius", offsetof(dem_outlet_desc, radius), FIELD_REAL, sizeof(((dem_outlet_desc *)0)->radius)},
    {"dem_outlet_desc", "material", offsetof(dem_outlet_desc, material), FIELD_INT, sizeof(((dem_outlet_desc *)0)->material)},
    {"dem_outlet_desc", "keep", offsetof(dem_outlet_desc, keep), FIELD_INT, sizeof(((dem_outlet_desc *)0)->keep)},
    {"dem_outlet_desc", "residence_bin", offsetof(dem_outlet_desc, residence_bin), FIELD_DOUBLE, sizeof(((dem_outlet_desc *)0)->residence_bin)},
    {"dem_cell_desc", "rate", offsetof(dem_cell_desc, rate), FIELD_REAL, sizeof(((dem_cell_desc *)0)->rate)},
    {"dem_cell_desc", "shear", offsetof(dem_cell_desc, shear), FIELD_REAL, sizeof(((dem_cell_desc *)0)->shear)},
    {"dem_cell_desc", "stress", offsetof(dem_cell_desc, stress), FIELD_REAL, sizeof(((dem_cell_desc *)0)->stress)},
    {"dem_cell_desc", "rate_most", offsetof(dem_cell_desc, rate_most), FIELD_REAL, sizeof(((dem_cell_desc *)0)->rate_most)},
    {"dem_trials_desc", "duration", offsetof(dem_trials_desc, duration), FIELD_DOUBLE, sizeof(((dem_trials_desc *)0)->duration)},
    {"dem_trials_desc", "budget", offsetof(dem_trials_desc, budget), FIELD_DOUBLE, sizeof(((dem_trials_desc *)0)->budget)},
    {"dem_trials_desc", "tolerance", offsetof(dem_trials_desc, tolerance), FIELD_DOUBLE, sizeof(((dem_trials_desc *)0)->tolerance)},
    {"dem_trials_desc", "seeds", offsetof(dem_trials_desc, seeds), FIELD_INT, sizeof(((dem_trials_desc *)0)->seeds)},
    {"dem_trials_desc", "observable_count", offsetof(dem_trials_desc, observable_count), FIELD_INT, sizeof(((dem_trials_desc *)0)->observable_count)},
    {"dem_trials_desc", "progress", offsetof(dem_trials_desc, progress), FIELD_POINTER, sizeof(((dem_trials_desc *)0)->progress)},
    {"dem_trials_desc", "user", offsetof(dem_trials_desc, user), FIELD_POINTER, sizeof(((dem_trials_desc *)0)->user)},
    {"dem_events_desc", "function", offsetof(dem_events_desc, function), FIELD_POINTER, sizeof(((dem_events_desc *)0)->function)},
    {"dem_events_desc", "user", offsetof(dem_events_desc, user), FIELD_POINTER, sizeof(((dem_events_desc *)0)->user)},
    {"dem_events_desc", "begins", offsetof(dem_events_desc, begins), FIELD_INT, sizeof(((dem_events_desc *)0)->begins)},
    {"dem_field_desc", "box", offsetof(dem_field_desc, box), FIELD_REAL, sizeof(((dem_field_desc *)0)->box)},
    {"dem_field_desc", "cells", offsetof(dem_field_desc, cells), FIELD_INT, sizeof(((dem_field_desc *)0)->cells)},
    {"dem_field_desc", "start", offsetof(dem_field_desc, start), FIELD_DOUBLE, sizeof(((dem_field_desc *)0)->start)},
    {"dem_field_desc", "end", offsetof(dem_field_desc, end), FIELD_DOUBLE, sizeof(((dem_field_desc *)0)->end)},
    {"dem_field_desc", "interval", offsetof(dem_field_desc, interval), FIELD_DOUBLE, sizeof(((dem_field_desc *)0)->interval)},
    {"dem_field_desc", "material", offsetof(dem_field_desc, material), FIELD_INT, sizeof(((dem_field_desc *)0)->material)},
    {"dem_field_desc", "radius_min", offsetof(dem_field_desc, radius_min), FIELD_REAL, sizeof(((dem_field_desc *)0)->radius_min)},
    {"dem_field_desc", "radius_max", offsetof(dem_field_desc, radius_max), FIELD_REAL, sizeof(((dem_field_desc *)0)->radius_max)},
    {"dem_field_desc", "stress", offsetof(dem_field_desc, stress), FIELD_INT, sizeof(((dem_field_desc *)0)->stress)},
    {"dem_field_desc", "width", offsetof(dem_field_desc, width), FIELD_REAL, sizeof(((dem_field_desc *)0)->width)},
    {"dem_field_desc", "group", offsetof(dem_field_desc, group), FIELD_INT, sizeof(((dem_field_desc *)0)->group)},
    {"dem_field_desc", "variance", offsetof(dem_field_desc, variance), FIELD_INT, sizeof(((dem_field_desc *)0)->variance)},
    {"dem_field_desc", "bodies", offsetof(dem_field_desc, bodies), FIELD_INT, sizeof(((dem_field_desc *)0)->bodies)},
    {"dem_mixing_desc", "box", offsetof(dem_mixing_desc, box), FIELD_REAL, sizeof(((dem_mixing_desc *)0)->box)},
    {"dem_mixing_desc", "cells", offsetof(dem_mixing_desc, cells), FIELD_INT, sizeof(((dem_mixing_desc *)0)->cells)},
    {"dem_mixing_desc", "material", offsetof(dem_mixing_desc, material), FIELD_INT, sizeof(((dem_mixing_desc *)0)->material)},
    {"dem_mixing_desc", "radius_min", offsetof(dem_mixing_desc, radius_min), FIELD_REAL, sizeof(((dem_mixing_desc *)0)->radius_min)},
    {"dem_mixing_desc", "radius_max", offsetof(dem_mixing_desc, radius_max), FIELD_REAL, sizeof(((dem_mixing_desc *)0)->radius_max)},
    {"dem_mixing_desc", "centre", offsetof(dem_mixing_desc, centre), FIELD_REAL, sizeof(((dem_mixing_desc *)0)->centre)},
    {"dem_mixing_desc", "axis", offsetof(dem_mixing_desc, axis), FIELD_REAL, sizeof(((dem_mixing_desc *)0)->axis)},
    {"dem_wall_part", "name", offsetof(dem_wall_part, name), FIELD_POINTER, sizeof(((dem_wall_part *)0)->name)},
    {"dem_wall_part", "material", offsetof(dem_wall_part, material), FIELD_INT, sizeof(((dem_wall_part *)0)->material)},
    {"dem_grains", "count", offsetof(dem_grains, count), FIELD_INT, sizeof(((dem_grains *)0)->count)},
    {"dem_grains", "positions", offsetof(dem_grains, positions), FIELD_POINTER, sizeof(((dem_grains *)0)->positions)},
    {"dem_grains", "radii", offsetof(dem_grains, radii), FIELD_POINTER, sizeof(((dem_grains *)0)->radii)},
    {"dem_grains", "velocities", offsetof(dem_grains, velocities), FIELD_POINTER, sizeof(((dem_grains *)0)->velocities)},
    {"dem_grains", "spins", offsetof(dem_grains, spins), FIELD_POINTER, sizeof(((dem_grains *)0)->spins)},
    {"dem_grains", "materials", offsetof(dem_grains, materials), FIELD_POINTER, sizeof(((dem_grains *)0)->materials)},
    {"dem_grains", "lines_left", offsetof(dem_grains, lines_left), FIELD_INT, sizeof(((dem_grains *)0)->lines_left)},
    {"dem_replay_desc", "title", offsetof(dem_replay_desc, title), FIELD_POINTER, sizeof(((dem_replay_desc *)0)->title)},
    {"dem_replay_desc", "number", offsetof(dem_replay_desc, number), FIELD_POINTER, sizeof(((dem_replay_desc *)0)->number)},
    {"dem_replay_desc", "user", offsetof(dem_replay_desc, user), FIELD_POINTER, sizeof(((dem_replay_desc *)0)->user)},
    {"dem_replay_desc", "resolution", offsetof(dem_replay_desc, resolution), FIELD_REAL, sizeof(((dem_replay_desc *)0)->resolution)},
    {"dem_replay_desc", "interval", offsetof(dem_replay_desc, interval), FIELD_DOUBLE, sizeof(((dem_replay_desc *)0)->interval)},
    {"dem_replay_desc", "contacts", offsetof(dem_replay_desc, contacts), FIELD_INT, sizeof(((dem_replay_desc *)0)->contacts)},
    {"dem_output_desc", "kind", offsetof(dem_output_desc, kind), FIELD_INT, sizeof(((dem_output_desc *)0)->kind)},
    {"dem_output_desc", "path", offsetof(dem_output_desc, path), FIELD_POINTER, sizeof(((dem_output_desc *)0)->path)},
    {"dem_output_desc", "interval", offsetof(dem_output_desc, interval), FIELD_DOUBLE, sizeof(((dem_output_desc *)0)->interval)},
    {"dem_output_desc", "start", offsetof(dem_output_desc, start), FIELD_DOUBLE, sizeof(((dem_output_desc *)0)->start)},
    {"dem_output_desc", "end", offsetof(dem_output_desc, end), FIELD_DOUBLE, sizeof(((dem_output_desc *)0)->end)},
    {"dem_output_desc", "wall", offsetof(dem_output_desc, wall), FIELD_INT, sizeof(((dem_output_desc *)0)->wall)},
    {"dem_output_desc", "columns", offsetof(dem_output_desc, columns), FIELD_POINTER, sizeof(((dem_output_desc *)0)->columns)},
    {"dem_output_desc", "user", offsetof(dem_output_desc, user), FIELD_POINTER, sizeof(((dem_output_desc *)0)->user)},
    {"dem_output_desc", "field", offsetof(dem_output_desc, field), FIELD_INT, sizeof(((dem_output_desc *)0)->field)},
    {"dem_output_desc", "z0", offsetof(dem_output_desc, z0), FIELD_REAL, sizeof(((dem_output_desc *)0)->z0)},
    {"dem_output_desc", "z1", offsetof(dem_output_desc, z1), FIELD_REAL, sizeof(((dem_output_desc *)0)->z1)},
    {"dem_output_desc", "outlet", offsetof(dem_output_desc, outlet), FIELD_INT, sizeof(((dem_output_desc *)0)->outlet)},
    {"dem_slabs_desc", "axis", offsetof(dem_slabs_desc, axis), FIELD_INT, sizeof(((dem_slabs_desc *)0)->axis)},
    {"dem_slabs_desc", "count", offsetof(dem_slabs_desc, count), FIELD_INT, sizeof(((dem_slabs_desc *)0)->count)},
    {"dem_slabs_desc", "first", offsetof(dem_slabs_desc, first), FIELD_INT, sizeof(((dem_slabs_desc *)0)->first)},
    {"dem_slabs_desc", "local", offsetof(dem_slabs_desc, local), FIELD_INT, sizeof(((dem_slabs_desc *)0)->local)},
    {"dem_slabs_desc", "balance", offsetof(dem_slabs_desc, balance), FIELD_REAL, sizeof(((dem_slabs_desc *)0)->balance)},
    {"dem_slabs_desc", "balance_interval", offsetof(dem_slabs_desc, balance_interval), FIELD_INT, sizeof(((dem_slabs_desc *)0)->balance_interval)},
    {0, 0, 0, 0, 0}};
TAKE_CONST(dem_material_desc)
TAKE_OUT(dem_material_desc)
TAKE_OUT(dem_pair)
TAKE_CONST(dem_pair)
TAKE_OUT(dem_coefficients)
TAKE_CONST(dem_sizes)
TAKE_OUT(dem_body_state)
TAKE_CONST(dem_body_state)
TAKE_CONST(dem_selection)
TAKE_OUT(dem_body)
TAKE_OUT(dem_bodies_means)
TAKE_CONST(dem_cluster_desc)
TAKE_CONST(dem_mesh)
TAKE_CONST(dem_shape)
TAKE_OUT(dem_shape_info)
TAKE_CONST(dem_profile)
TAKE_CONST(dem_sieve_desc)
TAKE_CONST(dem_motion)
TAKE_OUT(dem_vec3)
TAKE_OUT(dem_pose)
TAKE_OUT(dem_wall_loads)
TAKE_CONST(dem_joint_desc)
TAKE_OUT(dem_joint_state)
TAKE_CONST(dem_rail_desc)
TAKE_OUT(dem_rail_state)
TAKE_CONST(dem_feed_desc)
TAKE_OUT(dem_feed_state)
TAKE_CONST(dem_outlet_desc)
TAKE_OUT(dem_outlet_state)
TAKE_OUT(dem_advice)
TAKE_OUT(dem_finding)
TAKE_CONST(dem_cell_desc)
TAKE_OUT(dem_cell_state)
TAKE_CONST(dem_trials_desc)
TAKE_OUT(dem_trials)
TAKE_OUT(dem_contact_info)
TAKE_CONST(dem_events_desc)
TAKE_OUT(dem_impacts)
TAKE_OUT(dem_wear)
TAKE_OUT(dem_servo)
TAKE_OUT(dem_stress)
TAKE_CONST(dem_field_desc)
TAKE_OUT(dem_field_data)
TAKE_OUT(dem_field_cell)
TAKE_OUT(dem_body_means)
TAKE_CONST(dem_mixing_desc)
TAKE_OUT(dem_mixing)
TAKE_OUT(dem_repose)
TAKE_OUT(dem_mesh)
TAKE_OUT(dem_mesh_health)
TAKE_OUT(dem_spheres_fit)
TAKE_CONST(dem_wall_part)
TAKE_OUT(dem_wall)
TAKE_OUT(dem_profile)
TAKE_OUT(dem_grains)
TAKE_CONST(dem_grains)
TAKE_CONST(dem_replay_desc)
TAKE_CONST(dem_output_desc)
TAKE_CONST(dem_slabs_desc)
TAKE_OUT(dem_effect)

static int call_dem_world_error_get(refuser *r) {
    (void)dem_world_error_get(r->world);
    return 1;
}

static int call_dem_world_desc_get(refuser *r) {
    (void)dem_world_desc_get(r->world);
    return 1;
}

static int call_dem_material_add(refuser *r) {
    const dem_material_desc *desc = take_const_dem_material_desc(r, 2, "desc");
    return dem_material_add(r->world, desc).id != 0;
}

static int call_dem_material_set(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    const dem_material_desc *desc = take_const_dem_material_desc(r, 3, "desc");
    return dem_material_set(r->world, material, desc) == DEM_OK;
}

static int call_dem_material_get(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    dem_material_desc *desc = take_out_dem_material_desc(r, 3, "desc");
    return dem_material_get(r->world, material, desc) == DEM_OK;
}

static int call_dem_pair_get(refuser *r) {
    dem_material a = take_dem_material(r, 2, "a");
    dem_material b = take_dem_material(r, 3, "b");
    dem_pair *pair = take_out_dem_pair(r, 4, "pair");
    return dem_pair_get(r->world, a, b, pair) == DEM_OK;
}

static int call_dem_pair_set(refuser *r) {
    dem_material a = take_dem_material(r, 2, "a");
    dem_material b = take_dem_material(r, 3, "b");
    const dem_pair *pair = take_const_dem_pair(r, 4, "pair");
    return dem_pair_set(r->world, a, b, pair) == DEM_OK;
}

static int call_dem_coefficients_get(refuser *r) {
    dem_material a = take_dem_material(r, 2, "a");
    dem_material b = take_dem_material(r, 3, "b");
    dem_real radius_a = take_dem_real(r, 4, "radius_a");
    dem_real radius_b = take_dem_real(r, 5, "radius_b");
    dem_coefficients *out = take_out_dem_coefficients(r, 6, "out");
    return dem_coefficients_get(r->world, a, b, radius_a, radius_b, out) == DEM_OK;
}

static int call_dem_pairs_print(refuser *r) {
    FILE *out = take_out_FILE(r, 2, "out");
    dem_pairs_print(r->world, out);
    return 1;
}

static int call_dem_sphere_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    dem_real radius = take_dem_real(r, 3, "radius");
    dem_vec3 position = take_dem_vec3(r, 4, "position");
    return dem_sphere_add(r->world, material, radius, position).slot != 0;
}

static int call_dem_spheres_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    int count = take_int(r, 3, "count");
    const dem_real *positions = take_const_dem_real(r, 4, "positions");
    const dem_real *velocities = take_const_dem_real(r, 5, "velocities");
    const dem_real *radii = take_const_dem_real(r, 6, "radii");
    dem_real radius = take_dem_real(r, 7, "radius");
    return dem_spheres_add(r->world, material, count, positions, velocities, radii, radius) == DEM_OK;
}

static int call_dem_spheres_fill(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    dem_real radius = take_dem_real(r, 3, "radius");
    dem_region region = take_dem_region(r, 4, "region");
    int count = take_int(r, 5, "count");
    uint64_t seed = take_uint64_t(r, 6, "seed");
    return dem_spheres_fill(r->world, material, radius, region, count, seed) > 0;
}

static int call_dem_sizes_finer_get(refuser *r) {
    const dem_sizes *sizes = take_const_dem_sizes(r, 2, "sizes");
    dem_real radius = take_dem_real(r, 3, "radius");
    (void)dem_sizes_finer_get(r->world, sizes, radius);
    return 1;
}

static int call_dem_sizes_draw(refuser *r) {
    const dem_sizes *sizes = take_const_dem_sizes(r, 2, "sizes");
    int count = take_int(r, 3, "count");
    uint64_t seed = take_uint64_t(r, 4, "seed");
    dem_real *radii = take_out_dem_real(r, 5, "radii");
    return dem_sizes_draw(r->world, sizes, count, seed, radii) == DEM_OK;
}

static int call_dem_sizes_classes_get(refuser *r) {
    const dem_sizes *sizes = take_const_dem_sizes(r, 2, "sizes");
    int class_count = take_int(r, 3, "class_count");
    dem_real *radius = take_out_dem_real(r, 4, "radius");
    double *amount = take_out_double(r, 5, "amount");
    return dem_sizes_classes_get(r->world, sizes, class_count, radius, amount) > 0;
}

static int call_dem_sizes_fill(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    const dem_sizes *sizes = take_const_dem_sizes(r, 3, "sizes");
    dem_region region = take_dem_region(r, 4, "region");
    int count = take_int(r, 5, "count");
    uint64_t seed = take_uint64_t(r, 6, "seed");
    return dem_sizes_fill(r->world, material, sizes, region, count, seed) > 0;
}

static int call_dem_spheres_pack(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    dem_real radius = take_dem_real(r, 3, "radius");
    dem_real padding = take_dem_real(r, 4, "padding");
    dem_region region = take_dem_region(r, 5, "region");
    int count = take_int(r, 6, "count");
    return dem_spheres_pack(r->world, material, radius, padding, region, count) > 0;
}

static int call_dem_body_remove(refuser *r) {
    dem_body body = take_dem_body(r, 2, "body");
    return dem_body_remove(r->world, body) == DEM_OK;
}

static int call_dem_body_get(refuser *r) {
    dem_body body = take_dem_body(r, 2, "body");
    dem_body_state *state = take_out_dem_body_state(r, 3, "state");
    return dem_body_get(r->world, body, state) == DEM_OK;
}

static int call_dem_body_set(refuser *r) {
    dem_body body = take_dem_body(r, 2, "body");
    const dem_body_state *state = take_const_dem_body_state(r, 3, "state");
    return dem_body_set(r->world, body, state) == DEM_OK;
}

static int call_dem_body_radius_set(refuser *r) {
    dem_body body = take_dem_body(r, 2, "body");
    dem_real radius = take_dem_real(r, 3, "radius");
    return dem_body_radius_set(r->world, body, radius) == DEM_OK;
}

static int call_dem_temperature_get(refuser *r) {
    (void)dem_temperature_get(r->world);
    return 1;
}

static int call_dem_temperature_set(refuser *r) {
    double temperature = take_double(r, 2, "temperature");
    uint64_t seed = take_uint64_t(r, 3, "seed");
    return dem_temperature_set(r->world, temperature, seed) == DEM_OK;
}

static int call_dem_bodies_get(refuser *r) {
    (void)dem_bodies_get(r->world);
    return 1;
}

static int call_dem_body_id_get(refuser *r) {
    int index = take_int(r, 2, "index");
    return dem_body_id_get(r->world, index).slot != 0;
}

static int call_dem_group_get(refuser *r) {
    const char *name = take_const_char(r, 2, "name");
    (void)dem_group_get(r->world, name);
    return 1;
}

static int call_dem_bodies_select(refuser *r) {
    const dem_selection *selection = take_const_dem_selection(r, 2, "selection");
    dem_body *out = take_out_dem_body(r, 3, "out");
    int capacity = take_int(r, 4, "capacity");
    return dem_bodies_select(r->world, selection, out, capacity) > 0;
}

static int call_dem_bodies_group_set(refuser *r) {
    const dem_selection *selection = take_const_dem_selection(r, 2, "selection");
    dem_group group = take_dem_group(r, 3, "group");
    int member = take_int(r, 4, "member");
    return dem_bodies_group_set(r->world, selection, group, member) > 0;
}

static int call_dem_bodies_velocity_set(refuser *r) {
    const dem_selection *selection = take_const_dem_selection(r, 2, "selection");
    dem_vec3 velocity = take_dem_vec3(r, 3, "velocity");
    dem_vec3 spin = take_dem_vec3(r, 4, "spin");
    return dem_bodies_velocity_set(r->world, selection, velocity, spin) > 0;
}

static int call_dem_bodies_fixed_set(refuser *r) {
    const dem_selection *selection = take_const_dem_selection(r, 2, "selection");
    int fixed = take_int(r, 3, "fixed");
    return dem_bodies_fixed_set(r->world, selection, fixed) > 0;
}

static int call_dem_bodies_remove(refuser *r) {
    const dem_selection *selection = take_const_dem_selection(r, 2, "selection");
    return dem_bodies_remove(r->world, selection) > 0;
}

static int call_dem_bodies_means_get(refuser *r) {
    const dem_selection *selection = take_const_dem_selection(r, 2, "selection");
    dem_bodies_means *means = take_out_dem_bodies_means(r, 3, "means");
    return dem_bodies_means_get(r->world, selection, means) == DEM_OK;
}

static int call_dem_body_reals_get(refuser *r) {
    dem_body body = take_dem_body(r, 2, "body");
    dem_real *reals = take_out_dem_real(r, 3, "reals");
    return dem_body_reals_get(r->world, body, reals) == DEM_OK;
}

static int call_dem_body_reals_set(refuser *r) {
    dem_body body = take_dem_body(r, 2, "body");
    const dem_real *reals = take_const_dem_real(r, 3, "reals");
    return dem_body_reals_set(r->world, body, reals) == DEM_OK;
}

static int call_dem_bodies_reals_set(refuser *r) {
    const dem_real *reals = take_const_dem_real(r, 2, "reals");
    return dem_bodies_reals_set(r->world, reals) == DEM_OK;
}

static int call_dem_wall_reals_get(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    dem_real *reals = take_out_dem_real(r, 3, "reals");
    return dem_wall_reals_get(r->world, wall, reals) == DEM_OK;
}

static int call_dem_wall_reals_set(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    const dem_real *reals = take_const_dem_real(r, 3, "reals");
    return dem_wall_reals_set(r->world, wall, reals) == DEM_OK;
}

static int call_dem_shape_ellipsoid_add(refuser *r) {
    dem_vec3 semi_axes = take_dem_vec3(r, 2, "semi_axes");
    return dem_shape_ellipsoid_add(r->world, semi_axes).id != 0;
}

static int call_dem_shape_cluster_add(refuser *r) {
    const dem_cluster_desc *desc = take_const_dem_cluster_desc(r, 2, "desc");
    return dem_shape_cluster_add(r->world, desc).id != 0;
}

static int call_dem_shape_polyhedron_add(refuser *r) {
    int count = take_int(r, 2, "count");
    const dem_real *points = take_const_dem_real(r, 3, "points");
    return dem_shape_polyhedron_add(r->world, count, points).id != 0;
}

static int call_dem_shape_mesh_add(refuser *r) {
    const dem_mesh *mesh = take_const_dem_mesh(r, 2, "mesh");
    dem_real dent = take_dem_real(r, 3, "dent");
    return dem_shape_mesh_add(r->world, mesh, dent).id != 0;
}

static int call_dem_shape_union_add(refuser *r) {
    int count = take_int(r, 2, "count");
    const dem_shape *shapes = take_const_dem_shape(r, 3, "shapes");
    const dem_real *positions = take_const_dem_real(r, 4, "positions");
    const dem_real *orientations = take_const_dem_real(r, 5, "orientations");
    return dem_shape_union_add(r->world, count, shapes, positions, orientations).id != 0;
}

static int call_dem_shape_polygon_add(refuser *r) {
    int count = take_int(r, 2, "count");
    const dem_real *points = take_const_dem_real(r, 3, "points");
    return dem_shape_polygon_add(r->world, count, points).id != 0;
}

static int call_dem_shape_get(refuser *r) {
    dem_shape shape = take_dem_shape(r, 2, "shape");
    dem_shape_info *info = take_out_dem_shape_info(r, 3, "info");
    return dem_shape_get(r->world, shape, info) == DEM_OK;
}

static int call_dem_body_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    dem_shape shape = take_dem_shape(r, 3, "shape");
    dem_vec3 position = take_dem_vec3(r, 4, "position");
    dem_quat orientation = take_dem_quat(r, 5, "orientation");
    return dem_body_add(r->world, material, shape, position, orientation).slot != 0;
}

static int call_dem_bodies_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    dem_shape shape = take_dem_shape(r, 3, "shape");
    int count = take_int(r, 4, "count");
    const dem_real *positions = take_const_dem_real(r, 5, "positions");
    const dem_real *orientations = take_const_dem_real(r, 6, "orientations");
    const dem_real *velocities = take_const_dem_real(r, 7, "velocities");
    const dem_real *spins = take_const_dem_real(r, 8, "spins");
    const dem_real *scales = take_const_dem_real(r, 9, "scales");
    return dem_bodies_add(r->world, material, shape, count, positions, orientations, velocities, spins, scales) == DEM_OK;
}

static int call_dem_bodies_fill(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    dem_shape shape = take_dem_shape(r, 3, "shape");
    dem_region region = take_dem_region(r, 4, "region");
    int count = take_int(r, 5, "count");
    uint64_t seed = take_uint64_t(r, 6, "seed");
    return dem_bodies_fill(r->world, material, shape, region, count, seed) > 0;
}

static int call_dem_body_counts_get(refuser *r) {
    (void)dem_body_counts_get(r->world);
    return 1;
}

static int call_dem_wall_plane_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    dem_vec3 point = take_dem_vec3(r, 3, "point");
    dem_vec3 normal = take_dem_vec3(r, 4, "normal");
    return dem_wall_plane_add(r->world, material, point, normal).id != 0;
}

static int call_dem_wall_cylinder_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    dem_vec3 point = take_dem_vec3(r, 3, "point");
    dem_vec3 axis = take_dem_vec3(r, 4, "axis");
    dem_real radius = take_dem_real(r, 5, "radius");
    int inside = take_int(r, 6, "inside");
    return dem_wall_cylinder_add(r->world, material, point, axis, radius, inside).id != 0;
}

static int call_dem_wall_revolved_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    dem_vec3 point = take_dem_vec3(r, 3, "point");
    dem_vec3 axis = take_dem_vec3(r, 4, "axis");
    int count = take_int(r, 5, "count");
    const dem_real *radii = take_const_dem_real(r, 6, "radii");
    const dem_real *heights = take_const_dem_real(r, 7, "heights");
    return dem_wall_revolved_add(r->world, material, point, axis, count, radii, heights).id != 0;
}

static int call_dem_wall_cone_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    dem_vec3 from = take_dem_vec3(r, 3, "from");
    dem_vec3 to = take_dem_vec3(r, 4, "to");
    dem_real radius_from = take_dem_real(r, 5, "radius_from");
    dem_real radius_to = take_dem_real(r, 6, "radius_to");
    return dem_wall_cone_add(r->world, material, from, to, radius_from, radius_to).id != 0;
}

static int call_dem_wall_profile_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    const dem_profile *profile = take_const_dem_profile(r, 3, "profile");
    dem_edge_rule rule = take_dem_edge_rule(r, 4, "rule");
    return dem_wall_profile_add(r->world, material, profile, rule).id != 0;
}

static int call_dem_wall_mesh_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    const dem_mesh *mesh = take_const_dem_mesh(r, 3, "mesh");
    return dem_wall_mesh_add(r->world, material, mesh).id != 0;
}

static int call_dem_wall_grains_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    int count = take_int(r, 3, "count");
    const dem_real *positions = take_const_dem_real(r, 4, "positions");
    dem_real radius = take_dem_real(r, 5, "radius");
    dem_real share = take_dem_real(r, 6, "share");
    return dem_wall_grains_add(r->world, material, count, positions, radius, share).id != 0;
}

static int call_dem_wall_sieve_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    const dem_sieve_desc *desc = take_const_dem_sieve_desc(r, 3, "desc");
    return dem_wall_sieve_add(r->world, material, desc).id != 0;
}

static int call_dem_sieve_blinded_get(refuser *r) {
    dem_wall sieve = take_dem_wall(r, 2, "sieve");
    dem_real speed = take_dem_real(r, 3, "speed");
    return dem_sieve_blinded_get(r->world, sieve, speed) > 0;
}

static int call_dem_wall_motion_set(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    const dem_motion *motion = take_const_dem_motion(r, 3, "motion");
    return dem_wall_motion_set(r->world, wall, motion) == DEM_OK;
}

static int call_dem_wall_surface_velocity_set(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    dem_vec3 velocity = take_dem_vec3(r, 3, "velocity");
    return dem_wall_surface_velocity_set(r->world, wall, velocity) == DEM_OK;
}

static int call_dem_wall_surface_velocity_get(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    dem_vec3 *velocity = take_out_dem_vec3(r, 3, "velocity");
    return dem_wall_surface_velocity_get(r->world, wall, velocity) == DEM_OK;
}

static int call_dem_wall_pose_get(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    dem_pose *pose = take_out_dem_pose(r, 3, "pose");
    return dem_wall_pose_get(r->world, wall, pose) == DEM_OK;
}

static int call_dem_wall_remove(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    return dem_wall_remove(r->world, wall) == DEM_OK;
}

static int call_dem_wall_loads_get(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    dem_wall_loads *loads = take_out_dem_wall_loads(r, 3, "loads");
    return dem_wall_loads_get(r->world, wall, loads) == DEM_OK;
}

static int call_dem_wall_loads_reset(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    return dem_wall_loads_reset(r->world, wall) == DEM_OK;
}

static int call_dem_joint_add(refuser *r) {
    const dem_joint_desc *desc = take_const_dem_joint_desc(r, 2, "desc");
    return dem_joint_add(r->world, desc).id != 0;
}

static int call_dem_joint_motor_set(refuser *r) {
    dem_joint joint = take_dem_joint(r, 2, "joint");
    dem_motor motor = take_dem_motor(r, 3, "motor");
    dem_real speed = take_dem_real(r, 4, "speed");
    dem_real torque = take_dem_real(r, 5, "torque");
    return dem_joint_motor_set(r->world, joint, motor, speed, torque) == DEM_OK;
}

static int call_dem_joint_get(refuser *r) {
    dem_joint joint = take_dem_joint(r, 2, "joint");
    dem_joint_state *state = take_out_dem_joint_state(r, 3, "state");
    return dem_joint_get(r->world, joint, state) == DEM_OK;
}

static int call_dem_joint_remove(refuser *r) {
    dem_joint joint = take_dem_joint(r, 2, "joint");
    return dem_joint_remove(r->world, joint) == DEM_OK;
}

static int call_dem_body_rail_set(refuser *r) {
    dem_body body = take_dem_body(r, 2, "body");
    const dem_rail_desc *desc = take_const_dem_rail_desc(r, 3, "desc");
    return dem_body_rail_set(r->world, body, desc) == DEM_OK;
}

static int call_dem_body_reaction_get(refuser *r) {
    dem_body body = take_dem_body(r, 2, "body");
    dem_rail_state *state = take_out_dem_rail_state(r, 3, "state");
    return dem_body_reaction_get(r->world, body, state) == DEM_OK;
}

static int call_dem_feed_add(refuser *r) {
    const dem_feed_desc *desc = take_const_dem_feed_desc(r, 2, "desc");
    return dem_feed_add(r->world, desc).id != 0;
}

static int call_dem_feed_get(refuser *r) {
    dem_feed feed = take_dem_feed(r, 2, "feed");
    dem_feed_state *state = take_out_dem_feed_state(r, 3, "state");
    return dem_feed_get(r->world, feed, state) == DEM_OK;
}

static int call_dem_outlet_add(refuser *r) {
    const dem_outlet_desc *desc = take_const_dem_outlet_desc(r, 2, "desc");
    return dem_outlet_add(r->world, desc).id != 0;
}

static int call_dem_outlet_get(refuser *r) {
    dem_outlet outlet = take_dem_outlet(r, 2, "outlet");
    dem_outlet_state *state = take_out_dem_outlet_state(r, 3, "state");
    return dem_outlet_get(r->world, outlet, state) == DEM_OK;
}

static int call_dem_outlet_reset(refuser *r) {
    dem_outlet outlet = take_dem_outlet(r, 2, "outlet");
    return dem_outlet_reset(r->world, outlet) == DEM_OK;
}

static int call_dem_step_advice_get(refuser *r) {
    dem_advice *advice = take_out_dem_advice(r, 2, "advice");
    return dem_step_advice_get(r->world, advice) == DEM_OK;
}

static int call_dem_world_check(refuser *r) {
    dem_finding *findings = take_out_dem_finding(r, 2, "findings");
    int capacity = take_int(r, 3, "capacity");
    return dem_world_check(r->world, findings, capacity) > 0;
}

static int call_dem_world_check_print(refuser *r) {
    FILE *out = take_out_FILE(r, 2, "out");
    return dem_world_check_print(r->world, out) > 0;
}

static int call_dem_world_step(refuser *r) {
    int steps = take_int(r, 2, "steps");
    return dem_world_step(r->world, steps) == DEM_OK;
}

static int call_dem_world_run(refuser *r) {
    double seconds = take_double(r, 2, "seconds");
    dem_progress_fn progress = take_dem_progress_fn(r, 3, "progress");
    void *user = take_out_void(r, 4, "user");
    return dem_world_run(r->world, seconds, progress, user) == DEM_OK;
}

static int call_dem_world_run_to(refuser *r) {
    double time = take_double(r, 2, "time");
    dem_progress_fn progress = take_dem_progress_fn(r, 3, "progress");
    void *user = take_out_void(r, 4, "user");
    return dem_world_run_to(r->world, time, progress, user) == DEM_OK;
}

static int call_dem_world_settle(refuser *r) {
    double seconds = take_double(r, 2, "seconds");
    dem_real speed = take_dem_real(r, 3, "speed");
    dem_progress_fn progress = take_dem_progress_fn(r, 4, "progress");
    void *user = take_out_void(r, 5, "user");
    return dem_world_settle(r->world, seconds, speed, progress, user) == DEM_OK;
}

static int call_dem_progress_print(refuser *r) {
    double done = take_double(r, 2, "done");
    double seconds_left = take_double(r, 3, "seconds_left");
    void *user = take_out_void(r, 4, "user");
    return dem_progress_print(r->world, done, seconds_left, user) > 0;
}

static int call_dem_world_gravity_set(refuser *r) {
    dem_vec3 gravity = take_dem_vec3(r, 2, "gravity");
    return dem_world_gravity_set(r->world, gravity) == DEM_OK;
}

static int call_dem_cell_set(refuser *r) {
    const dem_cell_desc *desc = take_const_dem_cell_desc(r, 2, "desc");
    return dem_cell_set(r->world, desc) == DEM_OK;
}

static int call_dem_cell_state_get(refuser *r) {
    dem_cell_state *state = take_out_dem_cell_state(r, 2, "state");
    return dem_cell_state_get(r->world, state) == DEM_OK;
}

static int call_dem_world_dt_set(refuser *r) {
    dem_real dt = take_dem_real(r, 2, "dt");
    return dem_world_dt_set(r->world, dt) == DEM_OK;
}

static int call_dem_world_time_get(refuser *r) {
    (void)dem_world_time_get(r->world);
    return 1;
}

static int call_dem_world_steps_get(refuser *r) {
    (void)dem_world_steps_get(r->world);
    return 1;
}

static int call_dem_world_hash_get(refuser *r) {
    (void)dem_world_hash_get(r->world);
    return 1;
}

static int call_dem_counters_get(refuser *r) {
    (void)dem_counters_get(r->world);
    return 1;
}

static int call_dem_overlap_max_reset(refuser *r) {
    dem_overlap_max_reset(r->world);
    return 1;
}

static int call_dem_ledger_get(refuser *r) {
    (void)dem_ledger_get(r->world);
    return 1;
}

static int call_dem_totals_get(refuser *r) {
    (void)dem_totals_get(r->world);
    return 1;
}

static int call_dem_observer_height(refuser *r) {
    void *user = take_out_void(r, 2, "user");
    (void)dem_observer_height(r->world, user);
    return 1;
}

static int call_dem_observer_kinetic(refuser *r) {
    void *user = take_out_void(r, 2, "user");
    (void)dem_observer_kinetic(r->world, user);
    return 1;
}

static int call_dem_observer_contacts(refuser *r) {
    void *user = take_out_void(r, 2, "user");
    (void)dem_observer_contacts(r->world, user);
    return 1;
}

static int call_dem_observer_walls(refuser *r) {
    void *user = take_out_void(r, 2, "user");
    (void)dem_observer_walls(r->world, user);
    return 1;
}

static int call_dem_trials_run(refuser *r) {
    const dem_trials_desc *desc = take_const_dem_trials_desc(r, 2, "desc");
    dem_trials *trials = take_out_dem_trials(r, 3, "trials");
    return dem_trials_run(r->world, desc, trials) == DEM_OK;
}

static int call_dem_contacts_get(refuser *r) {
    dem_contact_info *out = take_out_dem_contact_info(r, 2, "out");
    int capacity = take_int(r, 3, "capacity");
    return dem_contacts_get(r->world, out, capacity) > 0;
}

static int call_dem_contacts_each(refuser *r) {
    dem_contact_fn fn = take_dem_contact_fn(r, 2, "fn");
    void *user = take_out_void(r, 3, "user");
    return dem_contacts_each(r->world, fn, user) > 0;
}

static int call_dem_bonds_make(refuser *r) {
    dem_real gap = take_dem_real(r, 2, "gap");
    dem_contact_fn make = take_dem_contact_fn(r, 3, "make");
    void *user = take_out_void(r, 4, "user");
    return dem_bonds_make(r->world, gap, make, user) > 0;
}

static int call_dem_candidates_get(refuser *r) {
    uint32_t *out = take_out_uint32_t(r, 2, "out");
    int capacity = take_int(r, 3, "capacity");
    return dem_candidates_get(r->world, out, capacity) > 0;
}

static int call_dem_candidates_rebuild(refuser *r) {
    return dem_candidates_rebuild(r->world) == DEM_OK;
}

static int call_dem_events_record(refuser *r) {
    const dem_events_desc *desc = take_const_dem_events_desc(r, 2, "desc");
    return dem_events_record(r->world, desc) == DEM_OK;
}

static int call_dem_events_stop(refuser *r) {
    return dem_events_stop(r->world) == DEM_OK;
}

static int call_dem_events_open_each(refuser *r) {
    dem_event_fn fn = take_dem_event_fn(r, 2, "fn");
    void *user = take_out_void(r, 3, "user");
    return dem_events_open_each(r->world, fn, user) > 0;
}

static int call_dem_impacts_get(refuser *r) {
    dem_material a = take_dem_material(r, 2, "a");
    dem_material b = take_dem_material(r, 3, "b");
    dem_impacts *impacts = take_out_dem_impacts(r, 4, "impacts");
    return dem_impacts_get(r->world, a, b, impacts) == DEM_OK;
}

static int call_dem_impacts_csv_write(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    return dem_impacts_csv_write(r->world, path) == DEM_OK;
}

static int call_dem_wall_wear_get(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    double coefficient = take_double(r, 3, "coefficient");
    double hardness = take_double(r, 4, "hardness");
    dem_wear *wear = take_out_dem_wear(r, 5, "wear");
    return dem_wall_wear_get(r->world, wall, coefficient, hardness, wear) == DEM_OK;
}

static int call_dem_wall_wear_facets_get(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    double *work = take_out_double(r, 3, "work");
    int capacity = take_int(r, 4, "capacity");
    return dem_wall_wear_facets_get(r->world, wall, work, capacity) > 0;
}

static int call_dem_wall_servo_get(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    dem_servo *servo = take_out_dem_servo(r, 3, "servo");
    return dem_wall_servo_get(r->world, wall, servo) == DEM_OK;
}

static int call_dem_stress_get(refuser *r) {
    dem_stress *stress = take_out_dem_stress(r, 2, "stress");
    return dem_stress_get(r->world, stress) == DEM_OK;
}

static int call_dem_field_add(refuser *r) {
    const dem_field_desc *desc = take_const_dem_field_desc(r, 2, "desc");
    return dem_field_add(r->world, desc).id != 0;
}

static int call_dem_field_get(refuser *r) {
    dem_field field = take_dem_field(r, 2, "field");
    dem_field_data *data = take_out_dem_field_data(r, 3, "data");
    return dem_field_get(r->world, field, data) == DEM_OK;
}

static int call_dem_field_cell_get(refuser *r) {
    dem_field field = take_dem_field(r, 2, "field");
    int i = take_int(r, 3, "i");
    int j = take_int(r, 4, "j");
    int k = take_int(r, 5, "k");
    dem_field_cell *cell = take_out_dem_field_cell(r, 6, "cell");
    return dem_field_cell_get(r->world, field, i, j, k, cell) == DEM_OK;
}

static int call_dem_body_means_get(refuser *r) {
    dem_body body = take_dem_body(r, 2, "body");
    dem_body_means *means = take_out_dem_body_means(r, 3, "means");
    return dem_body_means_get(r->world, body, means) == DEM_OK;
}

static int call_dem_field_reset(refuser *r) {
    dem_field field = take_dem_field(r, 2, "field");
    return dem_field_reset(r->world, field) == DEM_OK;
}

static int call_dem_mixing_get(refuser *r) {
    const dem_mixing_desc *desc = take_const_dem_mixing_desc(r, 2, "desc");
    dem_mixing *mixing = take_out_dem_mixing(r, 3, "mixing");
    return dem_mixing_get(r->world, desc, mixing) == DEM_OK;
}

static int call_dem_repose_heap_get(refuser *r) {
    dem_box box = take_dem_box(r, 2, "box");
    dem_repose *repose = take_out_dem_repose(r, 3, "repose");
    return dem_repose_heap_get(r->world, box, repose) == DEM_OK;
}

static int call_dem_repose_drum_get(refuser *r) {
    dem_box box = take_dem_box(r, 2, "box");
    dem_vec3 axis = take_dem_vec3(r, 3, "axis");
    dem_repose *repose = take_out_dem_repose(r, 4, "repose");
    return dem_repose_drum_get(r->world, box, axis, repose) == DEM_OK;
}

static int call_dem_mesh_read(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    dem_mesh *mesh = take_out_dem_mesh(r, 3, "mesh");
    dem_mesh_health *health = take_out_dem_mesh_health(r, 4, "health");
    const int good = dem_mesh_read(r->world, path, mesh, health) == DEM_OK;
    if (good) dem_mesh_free(r->world, mesh);
    return good;
}

static int call_dem_mesh_parse(refuser *r) {
    const char *name = take_const_char(r, 2, "name");
    const void *data = take_const_void(r, 3, "data");
    size_t size = take_size_t(r, 4, "size");
    dem_mesh *mesh = take_out_dem_mesh(r, 5, "mesh");
    dem_mesh_health *health = take_out_dem_mesh_health(r, 6, "health");
    const int good = dem_mesh_parse(r->world, name, data, size, mesh, health) == DEM_OK;
    if (good) dem_mesh_free(r->world, mesh);
    return good;
}

static int call_dem_mesh_part_read(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    const char *part = take_const_char(r, 3, "part");
    dem_mesh *mesh = take_out_dem_mesh(r, 4, "mesh");
    dem_mesh_health *health = take_out_dem_mesh_health(r, 5, "health");
    return dem_mesh_part_read(r->world, path, part, mesh, health) == DEM_OK;
}

static int call_dem_mesh_free(refuser *r) {
    dem_mesh *mesh = take_out_dem_mesh(r, 2, "mesh");
    dem_mesh_free(r->world, mesh);
    return 1;
}

static int call_dem_mesh_place(refuser *r) {
    dem_mesh *mesh = take_out_dem_mesh(r, 2, "mesh");
    dem_real scale = take_dem_real(r, 3, "scale");
    dem_quat rotation = take_dem_quat(r, 4, "rotation");
    dem_vec3 to = take_dem_vec3(r, 5, "to");
    return dem_mesh_place(r->world, mesh, scale, rotation, to) == DEM_OK;
}

static int call_dem_mesh_spheres(refuser *r) {
    const dem_mesh *mesh = take_const_dem_mesh(r, 2, "mesh");
    int count = take_int(r, 3, "count");
    dem_real *positions = take_out_dem_real(r, 4, "positions");
    dem_real *radii = take_out_dem_real(r, 5, "radii");
    dem_spheres_fit *fit = take_out_dem_spheres_fit(r, 6, "fit");
    return dem_mesh_spheres(r->world, mesh, count, positions, radii, fit) == DEM_OK;
}

static int call_dem_wall_parts_add(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    dem_real scale = take_dem_real(r, 3, "scale");
    int count = take_int(r, 4, "count");
    const dem_wall_part *parts = take_const_dem_wall_part(r, 5, "parts");
    dem_wall *walls = take_out_dem_wall(r, 6, "walls");
    return dem_wall_parts_add(r->world, path, scale, count, parts, walls) == DEM_OK;
}

static int call_dem_profile_read(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    dem_profile *profile = take_out_dem_profile(r, 3, "profile");
    const int good = dem_profile_read(r->world, path, profile) == DEM_OK;
    if (good) dem_profile_free(r->world, profile);
    return good;
}

static int call_dem_profile_parse(refuser *r) {
    const char *name = take_const_char(r, 2, "name");
    const void *data = take_const_void(r, 3, "data");
    size_t size = take_size_t(r, 4, "size");
    dem_profile *profile = take_out_dem_profile(r, 5, "profile");
    const int good = dem_profile_parse(r->world, name, data, size, profile) == DEM_OK;
    if (good) dem_profile_free(r->world, profile);
    return good;
}

static int call_dem_profile_free(refuser *r) {
    dem_profile *profile = take_out_dem_profile(r, 2, "profile");
    dem_profile_free(r->world, profile);
    return 1;
}

static int call_dem_grains_read(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    dem_grains *grains = take_out_dem_grains(r, 3, "grains");
    const int good = dem_grains_read(r->world, path, grains) == DEM_OK;
    if (good) dem_grains_free(r->world, grains);
    return good;
}

static int call_dem_grains_parse(refuser *r) {
    const char *name = take_const_char(r, 2, "name");
    const void *data = take_const_void(r, 3, "data");
    size_t size = take_size_t(r, 4, "size");
    dem_grains *grains = take_out_dem_grains(r, 5, "grains");
    const int good = dem_grains_parse(r->world, name, data, size, grains) == DEM_OK;
    if (good) dem_grains_free(r->world, grains);
    return good;
}

static int call_dem_grains_free(refuser *r) {
    dem_grains *grains = take_out_dem_grains(r, 2, "grains");
    dem_grains_free(r->world, grains);
    return 1;
}

static int call_dem_grains_add(refuser *r) {
    dem_material material = take_dem_material(r, 2, "material");
    const dem_grains *grains = take_const_dem_grains(r, 3, "grains");
    return dem_grains_add(r->world, material, grains) == DEM_OK;
}

static int call_dem_vtp_write(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    return dem_vtp_write(r->world, path) == DEM_OK;
}

static int call_dem_vtk_write(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    return dem_vtk_write(r->world, path) == DEM_OK;
}

static int call_dem_xyz_write(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    return dem_xyz_write(r->world, path) == DEM_OK;
}

static int call_dem_contacts_vtp_write(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    return dem_contacts_vtp_write(r->world, path) == DEM_OK;
}

static int call_dem_walls_vtp_write(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    dem_real z0 = take_dem_real(r, 3, "z0");
    dem_real z1 = take_dem_real(r, 4, "z1");
    return dem_walls_vtp_write(r->world, path, z0, z1) == DEM_OK;
}

static int call_dem_surfaces_vtp_write(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    return dem_surfaces_vtp_write(r->world, path) == DEM_OK;
}

static int call_dem_wall_loads_csv_write(refuser *r) {
    dem_wall wall = take_dem_wall(r, 2, "wall");
    const char *path = take_const_char(r, 3, "path");
    return dem_wall_loads_csv_write(r->world, wall, path) == DEM_OK;
}

static int call_dem_bodies_csv_write(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    return dem_bodies_csv_write(r->world, path) == DEM_OK;
}

static int call_dem_contacts_csv_write(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    return dem_contacts_csv_write(r->world, path) == DEM_OK;
}

static int call_dem_field_csv_write(refuser *r) {
    dem_field field = take_dem_field(r, 2, "field");
    const char *path = take_const_char(r, 3, "path");
    return dem_field_csv_write(r->world, field, path) == DEM_OK;
}

static int call_dem_outlet_residence_csv_write(refuser *r) {
    dem_outlet outlet = take_dem_outlet(r, 2, "outlet");
    const char *path = take_const_char(r, 3, "path");
    return dem_outlet_residence_csv_write(r->world, outlet, path) == DEM_OK;
}

static int call_dem_replay_open(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    const dem_replay_desc *desc = take_const_dem_replay_desc(r, 3, "desc");
    return replay_dropped(dem_replay_open(r->world, path, desc));
}

static int call_dem_checkpoint_write(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    return dem_checkpoint_write(r->world, path) == DEM_OK;
}

static int call_dem_checkpoint_read(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    return dem_checkpoint_read(r->world, path) == DEM_OK;
}

static int call_dem_checkpoint_read_changed(refuser *r) {
    const char *path = take_const_char(r, 2, "path");
    const char *allowed = take_const_char(r, 3, "allowed");
    return dem_checkpoint_read_changed(r->world, path, allowed) == DEM_OK;
}

static int call_dem_checkpoint_changes_get(refuser *r) {
    (void)dem_checkpoint_changes_get(r->world);
    return 1;
}

static int call_dem_output_add(refuser *r) {
    const dem_output_desc *desc = take_const_dem_output_desc(r, 2, "desc");
    return dem_output_add(r->world, desc).id != 0;
}

static int call_dem_output_every_add(refuser *r) {
    dem_output_kind kind = take_dem_output_kind(r, 2, "kind");
    const char *path = take_const_char(r, 3, "path");
    double interval = take_double(r, 4, "interval");
    return dem_output_every_add(r->world, kind, path, interval).id != 0;
}

static int call_dem_output_remove(refuser *r) {
    dem_output output = take_dem_output(r, 2, "output");
    return dem_output_remove(r->world, output) == DEM_OK;
}

static int call_dem_slabs_create(refuser *r) {
    const dem_slabs_desc *desc = take_const_dem_slabs_desc(r, 2, "desc");
    return slabs_dropped(dem_slabs_create(r->world, desc));
}

static int call_dem_effects_get(refuser *r) {
    double budget = take_double(r, 2, "budget");
    dem_effect *effects = take_out_dem_effect(r, 3, "effects");
    return dem_effects_get(r->world, budget, effects) > 0;
}

static int call_dem_effects_print(refuser *r) {
    double budget = take_double(r, 2, "budget");
    FILE *out = take_out_FILE(r, 3, "out");
    dem_effects_print(r->world, budget, out);
    return 1;
}

static int call_dem_world_report(refuser *r) {
    FILE *out = take_out_FILE(r, 2, "out");
    dem_world_report(r->world, out);
    return 1;
}

static const refused_call refused_calls[] = {
    {"dem_world_error_get", call_dem_world_error_get, 1},
    {"dem_world_desc_get", call_dem_world_desc_get, 1},
    {"dem_material_add", call_dem_material_add, 0},
    {"dem_material_set", call_dem_material_set, 0},
    {"dem_material_get", call_dem_material_get, 1},
    {"dem_pair_get", call_dem_pair_get, 1},
    {"dem_pair_set", call_dem_pair_set, 0},
    {"dem_coefficients_get", call_dem_coefficients_get, 1},
    {"dem_pairs_print", call_dem_pairs_print, 1},
    {"dem_sphere_add", call_dem_sphere_add, 0},
    {"dem_spheres_add", call_dem_spheres_add, 0},
    {"dem_spheres_fill", call_dem_spheres_fill, 0},
    {"dem_sizes_finer_get", call_dem_sizes_finer_get, 0},
    {"dem_sizes_draw", call_dem_sizes_draw, 0},
    {"dem_sizes_classes_get", call_dem_sizes_classes_get, 0},
    {"dem_sizes_fill", call_dem_sizes_fill, 0},
    {"dem_spheres_pack", call_dem_spheres_pack, 0},
    {"dem_body_remove", call_dem_body_remove, 0},
    {"dem_body_get", call_dem_body_get, 1},
    {"dem_body_set", call_dem_body_set, 0},
    {"dem_body_radius_set", call_dem_body_radius_set, 0},
    {"dem_temperature_get", call_dem_temperature_get, 1},
    {"dem_temperature_set", call_dem_temperature_set, 0},
    {"dem_bodies_get", call_dem_bodies_get, 1},
    {"dem_body_id_get", call_dem_body_id_get, 1},
    {"dem_group_get", call_dem_group_get, 1},
    {"dem_bodies_select", call_dem_bodies_select, 1},
    {"dem_bodies_group_set", call_dem_bodies_group_set, 0},
    {"dem_bodies_velocity_set", call_dem_bodies_velocity_set, 0},
    {"dem_bodies_fixed_set", call_dem_bodies_fixed_set, 0},
    {"dem_bodies_remove", call_dem_bodies_remove, 0},
    {"dem_bodies_means_get", call_dem_bodies_means_get, 1},
    {"dem_body_reals_get", call_dem_body_reals_get, 1},
    {"dem_body_reals_set", call_dem_body_reals_set, 0},
    {"dem_bodies_reals_set", call_dem_bodies_reals_set, 0},
    {"dem_wall_reals_get", call_dem_wall_reals_get, 1},
    {"dem_wall_reals_set", call_dem_wall_reals_set, 0},
    {"dem_shape_ellipsoid_add", call_dem_shape_ellipsoid_add, 0},
    {"dem_shape_cluster_add", call_dem_shape_cluster_add, 0},
    {"dem_shape_polyhedron_add", call_dem_shape_polyhedron_add, 0},
    {"dem_shape_mesh_add", call_dem_shape_mesh_add, 0},
    {"dem_shape_union_add", call_dem_shape_union_add, 0},
    {"dem_shape_polygon_add", call_dem_shape_polygon_add, 0},
    {"dem_shape_get", call_dem_shape_get, 1},
    {"dem_body_add", call_dem_body_add, 0},
    {"dem_bodies_add", call_dem_bodies_add, 0},
    {"dem_bodies_fill", call_dem_bodies_fill, 0},
    {"dem_body_counts_get", call_dem_body_counts_get, 1},
    {"dem_wall_plane_add", call_dem_wall_plane_add, 0},
    {"dem_wall_cylinder_add", call_dem_wall_cylinder_add, 0},
    {"dem_wall_revolved_add", call_dem_wall_revolved_add, 0},
    {"dem_wall_cone_add", call_dem_wall_cone_add, 0},
    {"dem_wall_profile_add", call_dem_wall_profile_add, 0},
    {"dem_wall_mesh_add", call_dem_wall_mesh_add, 0},
    {"dem_wall_grains_add", call_dem_wall_grains_add, 0},
    {"dem_wall_sieve_add", call_dem_wall_sieve_add, 0},
    {"dem_sieve_blinded_get", call_dem_sieve_blinded_get, 1},
    {"dem_wall_motion_set", call_dem_wall_motion_set, 0},
    {"dem_wall_surface_velocity_set", call_dem_wall_surface_velocity_set, 0},
    {"dem_wall_surface_velocity_get", call_dem_wall_surface_velocity_get, 1},
    {"dem_wall_pose_get", call_dem_wall_pose_get, 1},
    {"dem_wall_remove", call_dem_wall_remove, 0},
    {"dem_wall_loads_get", call_dem_wall_loads_get, 1},
    {"dem_wall_loads_reset", call_dem_wall_loads_reset, 0},
    {"dem_joint_add", call_dem_joint_add, 0},
    {"dem_joint_motor_set", call_dem_joint_motor_set, 0},
    {"dem_joint_get", call_dem_joint_get, 1},
    {"dem_joint_remove", call_dem_joint_remove, 0},
    {"dem_body_rail_set", call_dem_body_rail_set, 0},
    {"dem_body_reaction_get", call_dem_body_reaction_get, 1},
    {"dem_feed_add", call_dem_feed_add, 0},
    {"dem_feed_get", call_dem_feed_get, 1},
    {"dem_outlet_add", call_dem_outlet_add, 0},
    {"dem_outlet_get", call_dem_outlet_get, 1},
    {"dem_outlet_reset", call_dem_outlet_reset, 0},
    {"dem_step_advice_get", call_dem_step_advice_get, 1},
    {"dem_world_check", call_dem_world_check, 0},
    {"dem_world_check_print", call_dem_world_check_print, 0},
    {"dem_world_step", call_dem_world_step, 0},
    {"dem_world_run", call_dem_world_run, 0},
    {"dem_world_run_to", call_dem_world_run_to, 0},
    {"dem_world_settle", call_dem_world_settle, 0},
    {"dem_progress_print", call_dem_progress_print, 1},
    {"dem_world_gravity_set", call_dem_world_gravity_set, 0},
    {"dem_cell_set", call_dem_cell_set, 0},
    {"dem_cell_state_get", call_dem_cell_state_get, 1},
    {"dem_world_dt_set", call_dem_world_dt_set, 0},
    {"dem_world_time_get", call_dem_world_time_get, 1},
    {"dem_world_steps_get", call_dem_world_steps_get, 1},
    {"dem_world_hash_get", call_dem_world_hash_get, 1},
    {"dem_counters_get", call_dem_counters_get, 1},
    {"dem_overlap_max_reset", call_dem_overlap_max_reset, 0},
    {"dem_ledger_get", call_dem_ledger_get, 1},
    {"dem_totals_get", call_dem_totals_get, 1},
    {"dem_observer_height", call_dem_observer_height, 1},
    {"dem_observer_kinetic", call_dem_observer_kinetic, 1},
    {"dem_observer_contacts", call_dem_observer_contacts, 1},
    {"dem_observer_walls", call_dem_observer_walls, 1},
    {"dem_trials_run", call_dem_trials_run, 0},
    {"dem_contacts_get", call_dem_contacts_get, 1},
    {"dem_contacts_each", call_dem_contacts_each, 0},
    {"dem_bonds_make", call_dem_bonds_make, 0},
    {"dem_candidates_get", call_dem_candidates_get, 1},
    {"dem_candidates_rebuild", call_dem_candidates_rebuild, 0},
    {"dem_events_record", call_dem_events_record, 0},
    {"dem_events_stop", call_dem_events_stop, 0},
    {"dem_events_open_each", call_dem_events_open_each, 0},
    {"dem_impacts_get", call_dem_impacts_get, 0},
    {"dem_impacts_csv_write", call_dem_impacts_csv_write, 0},
    {"dem_wall_wear_get", call_dem_wall_wear_get, 0},
    {"dem_wall_wear_facets_get", call_dem_wall_wear_facets_get, 0},
    {"dem_wall_servo_get", call_dem_wall_servo_get, 1},
    {"dem_stress_get", call_dem_stress_get, 1},
    {"dem_field_add", call_dem_field_add, 0},
    {"dem_field_get", call_dem_field_get, 1},
    {"dem_field_cell_get", call_dem_field_cell_get, 1},
    {"dem_body_means_get", call_dem_body_means_get, 1},
    {"dem_field_reset", call_dem_field_reset, 0},
    {"dem_mixing_get", call_dem_mixing_get, 1},
    {"dem_repose_heap_get", call_dem_repose_heap_get, 1},
    {"dem_repose_drum_get", call_dem_repose_drum_get, 1},
    {"dem_mesh_read", call_dem_mesh_read, 0},
    {"dem_mesh_parse", call_dem_mesh_parse, 0},
    {"dem_mesh_part_read", call_dem_mesh_part_read, 0},
    {"dem_mesh_free", call_dem_mesh_free, 0},
    {"dem_mesh_place", call_dem_mesh_place, 0},
    {"dem_mesh_spheres", call_dem_mesh_spheres, 0},
    {"dem_wall_parts_add", call_dem_wall_parts_add, 0},
    {"dem_profile_read", call_dem_profile_read, 0},
    {"dem_profile_parse", call_dem_profile_parse, 0},
    {"dem_profile_free", call_dem_profile_free, 0},
    {"dem_grains_read", call_dem_grains_read, 0},
    {"dem_grains_parse", call_dem_grains_parse, 0},
    {"dem_grains_free", call_dem_grains_free, 0},
    {"dem_grains_add", call_dem_grains_add, 0},
    {"dem_vtp_write", call_dem_vtp_write, 0},
    {"dem_vtk_write", call_dem_vtk_write, 0},
    {"dem_xyz_write", call_dem_xyz_write, 0},
    {"dem_contacts_vtp_write", call_dem_contacts_vtp_write, 0},
    {"dem_walls_vtp_write", call_dem_walls_vtp_write, 0},
    {"dem_surfaces_vtp_write", call_dem_surfaces_vtp_write, 0},
    {"dem_wall_loads_csv_write", call_dem_wall_loads_csv_write, 0},
    {"dem_bodies_csv_write", call_dem_bodies_csv_write, 0},
    {"dem_contacts_csv_write", call_dem_contacts_csv_write, 0},
    {"dem_field_csv_write", call_dem_field_csv_write, 0},
    {"dem_outlet_residence_csv_write", call_dem_outlet_residence_csv_write, 0},
    {"dem_replay_open", call_dem_replay_open, 0},
    {"dem_checkpoint_write", call_dem_checkpoint_write, 0},
    {"dem_checkpoint_read", call_dem_checkpoint_read, 0},
    {"dem_checkpoint_read_changed", call_dem_checkpoint_read_changed, 0},
    {"dem_checkpoint_changes_get", call_dem_checkpoint_changes_get, 1},
    {"dem_output_add", call_dem_output_add, 0},
    {"dem_output_every_add", call_dem_output_every_add, 0},
    {"dem_output_remove", call_dem_output_remove, 0},
    {"dem_slabs_create", call_dem_slabs_create, 0},
    {"dem_effects_get", call_dem_effects_get, 0},
    {"dem_effects_print", call_dem_effects_print, 0},
    {"dem_world_report", call_dem_world_report, 1},
    {0, 0, 0}};
