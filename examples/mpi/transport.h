/* transport.h - the transport of dem_slabs_desc over MPI: the two functions by which slabs in several
   processes communicate. Include it after dem.h. */
#ifndef TRANSPORT_H
#define TRANSPORT_H
#include <mpi.h>

enum { TAG_UP = 1, TAG_DOWN = 2 };

static int mpi_exchange(const void *to_lower, size_t to_lower_size, void *from_lower,
                    size_t from_lower_size, const void *to_upper, size_t to_upper_size,
                    void *from_upper, size_t from_upper_size, void *user) {
    MPI_Request requests[4];
    int rank, size, lower, upper;
    (void)user;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    lower = (rank + size - 1)%size;
    upper = (rank + 1)%size;
    MPI_Irecv(from_lower, (int)from_lower_size, MPI_BYTE, lower, TAG_UP, MPI_COMM_WORLD,
              &requests[0]);
    MPI_Irecv(from_upper, (int)from_upper_size, MPI_BYTE, upper, TAG_DOWN, MPI_COMM_WORLD,
              &requests[1]);
    MPI_Isend((void *)to_upper, (int)to_upper_size, MPI_BYTE, upper, TAG_UP, MPI_COMM_WORLD,
              &requests[2]);
    MPI_Isend((void *)to_lower, (int)to_lower_size, MPI_BYTE, lower, TAG_DOWN, MPI_COMM_WORLD,
              &requests[3]);
    return MPI_Waitall(4, requests, MPI_STATUSES_IGNORE) != MPI_SUCCESS;
}
static int mpi_reduce(double *values, int count, int sum, void *user) {
    (void)user;
    return MPI_Allreduce(MPI_IN_PLACE, values, count, MPI_DOUBLE, sum ? MPI_SUM : MPI_MAX,
                         MPI_COMM_WORLD) != MPI_SUCCESS;
}

#endif
