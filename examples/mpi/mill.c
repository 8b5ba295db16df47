/* mill.c - the tumbling mill of examples/mill.c over MPI: its drum is cut across x into slabs, one
   for each process.

       mpicc -O2 -ffp-contract=off -I. examples/mpi/mill.c -o build/mill_mpi -lm   (or: make mpi)
       mpirun -n 2 build/mill_mpi --quick --out build/out/mill_mpi

   Options, results and pictures are those of build/mill; the first process writes them. With N
   processes the hash is that of build/mill --slabs N: the bits depend on the number of slabs only. */
#define main mill_main
#include "../mill.c"
#undef main
#include "transport.h"

int main(int argc, char **argv) {
    int code;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &mill_rank);
    MPI_Comm_size(MPI_COMM_WORLD, &mill_ranks);
    mill_transport.exchange_fn = mpi_exchange;
    mill_transport.reduce_fn = mpi_reduce;
    options.slabs = mill_ranks;
    options.threads = 1;
    study.quiet = mill_rank > 0;
    code = mill_main(argc, argv);
    MPI_Finalize();
    return code;
}
