/* groups.h - included before dem.h where relations are compiled: the number of spheres of a work group is a
   variable, so that one program runs scenes in one group and in several (DEM_DOMAIN_BODIES). */
#ifndef REL_GROUPS_H
#define REL_GROUPS_H
extern int rel_domain_bodies;
#define DEM_DOMAIN_BODIES rel_domain_bodies
#endif
