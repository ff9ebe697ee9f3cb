! barchan from Fortran, through iso_c_binding: spheres sink in oil until drag and weight balance (fluid.toml).
!
!     mpifort sink.f90 -o sink_f $(pkg-config --libs barchan)
!     mpirun -n 2 ./sink_f fluid.toml
!
! The interfaces below are those of barchan.h that this program needs; others follow the same pattern. Loads are
! set by id here; sink.c writes them in place.
module barchan
  use, intrinsic :: iso_c_binding
  implicit none
  integer(c_int), parameter :: position = 0, velocity = 1, radius = 5

  type, bind(c) :: info_t
    real(c_double) :: time, step_length
    integer(c_int64_t) :: step, num_particles, num_owned, generation
    integer(c_int32_t) :: dimension, num_bricks, num_walls, stage, stopped
  end type
  type, bind(c) :: view_t
    type(c_ptr) :: data
    integer(c_int64_t) :: size, stride
    integer(c_int32_t) :: width
  end type

  interface
    integer(c_int) function barchan_open(deck, settings, comm, sim) bind(c)
      import
      character(kind=c_char), intent(in) :: deck(*), settings(*)
      integer(c_int), value :: comm
      type(c_ptr), intent(out) :: sim
    end function
    integer(c_int) function barchan_close(sim) bind(c)
      import
      type(c_ptr), value :: sim
    end function
    integer(c_int) function barchan_run(sim, steps, done) bind(c)
      import
      type(c_ptr), value :: sim, done
      integer(c_int64_t), value :: steps
    end function
    integer(c_int) function barchan_get_info(sim, info) bind(c)
      import
      type(c_ptr), value :: sim
      type(info_t), intent(out) :: info
    end function
    integer(c_int) function barchan_get_view(sim, brick, field, view) bind(c)
      import
      type(c_ptr), value :: sim
      integer(c_int), value :: brick, field
      type(view_t), intent(out) :: view
    end function
    integer(c_int) function barchan_get_ids(sim, brick, ids, size) bind(c)
      import
      type(c_ptr), value :: sim
      integer(c_int), value :: brick
      type(c_ptr), intent(out) :: ids
      integer(c_int64_t), intent(out) :: size
    end function
    integer(c_int) function barchan_set_loads(sim, count, ids, forces, torques) bind(c)
      import
      type(c_ptr), value :: sim, ids, torques
      integer(c_int64_t), value :: count
      real(c_double), intent(in) :: forces(3, *)
    end function
    type(c_ptr) function barchan_error() bind(c)
      import
    end function
    integer(c_size_t) function c_strlen(text) bind(c, name="strlen")
      import
      type(c_ptr), value :: text
    end function
  end interface

contains

  ! The field of a brick as an array: component c of particle i is a(c, i).
  function array_of(sim, brick, field) result(a)
    type(c_ptr), intent(in) :: sim
    integer, intent(in) :: brick, field
    real(c_double), pointer :: a(:, :)
    type(view_t) :: view
    call check(barchan_get_view(sim, int(brick, c_int), int(field, c_int), view))
    if (view%size == 0) then
      allocate (a(view%width, 0))
    else
      call c_f_pointer(view%data, a, [view%stride, view%size])
    end if
  end function

  subroutine check(code)
    use mpi
    integer(c_int), intent(in) :: code
    character(kind=c_char), pointer :: text(:)
    type(c_ptr) :: what
    integer :: ierr
    if (code == 0) return
    what = barchan_error()
    call c_f_pointer(what, text, [c_strlen(what)])
    print *, "sink: ", text
    call MPI_Abort(MPI_COMM_WORLD, 1, ierr)
  end subroutine
end module

program sink
  use mpi
  use barchan
  implicit none
  real(c_double), parameter :: pi = 3.14159265358979323846_c_double, viscosity = 0.05_c_double
  real(c_double), parameter :: density = 2500, fluid = 970, gravity = 9.81_c_double, r = 0.5e-3_c_double
  real(c_double) :: relaxation, speed, expected
  type(c_ptr) :: sim
  type(info_t) :: info
  character(len=1024) :: deck
  integer :: ierr, level, rank

  call MPI_Init_thread(MPI_THREAD_SERIALIZED, level, ierr)
  call MPI_Comm_rank(MPI_COMM_WORLD, rank, ierr)
  deck = "fluid.toml"
  if (command_argument_count() > 0) call get_command_argument(1, deck)
  call check(barchan_open(trim(deck)//c_null_char, "--threads=1"//c_null_char, MPI_COMM_WORLD, sim))

  relaxation = density * 4 / 3 * pi * r**3 / (6 * pi * viscosity * r)
  do
    call couple()
    call check(barchan_run(sim, 10_c_int64_t, c_null_ptr))
    call check(barchan_get_info(sim, info))
    if (info%time >= 20 * relaxation) exit
  end do

  speed = -sum_of_velocities() / info%num_particles
  expected = 2 * (density - fluid) * gravity * r**2 / (9 * viscosity)
  call check(barchan_close(sim))
  if (rank == 0) print '(i0, a, f8.5, a, f8.5, a)', info%num_particles, " spheres sink at ", 1e3 * speed, &
    " mm/s, theory says ", 1e3 * expected, " mm/s"
  call MPI_Finalize(ierr)
  if (abs(speed / expected - 1) > 1e-3) stop 1

contains

  subroutine couple()
    real(c_double), pointer :: v(:, :), radii(:, :)
    real(c_double), allocatable :: forces(:, :)
    type(c_ptr) :: ids
    integer(c_int64_t) :: n
    integer :: b, i
    call check(barchan_get_info(sim, info))
    do b = 0, info%num_bricks - 1
      v => array_of(sim, b, velocity)
      radii => array_of(sim, b, radius)
      call check(barchan_get_ids(sim, b, ids, n))
      allocate (forces(3, n))
      do i = 1, int(n)
        forces(:, i) = -6 * pi * viscosity * radii(1, i) * v(1:3, i)
        forces(3, i) = forces(3, i) + 4 * pi * radii(1, i)**3 * fluid * gravity / 3
      end do
      call check(barchan_set_loads(sim, n, ids, forces, c_null_ptr))
      deallocate (forces)
    end do
  end subroutine

  real(c_double) function sum_of_velocities() result(total)
    real(c_double), pointer :: v(:, :)
    integer :: b
    total = 0
    do b = 0, info%num_bricks - 1
      v => array_of(sim, b, velocity)
      total = total + sum(v(3, :))
    end do
    call MPI_Allreduce(MPI_IN_PLACE, total, 1, MPI_DOUBLE_PRECISION, MPI_SUM, MPI_COMM_WORLD, ierr)
  end function
end program
