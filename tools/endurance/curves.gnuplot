# Called by draw-curves with: folder, work (a file for each process), names (of those), faults (times), last (minutes).
set terminal pngcairo size 1800,2100 font "DejaVu Sans,11"
set output folder."/curves.png"
set multiplot layout 5,2 margins 0.05,0.985,0.04,0.975 spacing 0.06,0.045
set grid back linetype 1 linecolor rgb "#dddddd" linewidth 0.5
set key top right opaque samplen 1.5 font ",9"
set xrange [0:last]
set yrange [0:*]
set tics out nomirror
set border 3
set style data lines
blue = 0x4477aa; red = 0xee6677; green = 0x228833; yellow = 0xccbb44
array colours[12] = [0x4477aa, 0xee6677, 0x228833, 0xccbb44, 0x66ccee, 0xaa3377, 0x999933, 0x882255, 0x44aa99, 0x332288, 0xcc6600, 0x777777]
do for [at in faults] {  # faults that were made
  set arrow from first at, graph 0 to first at, graph 1 nohead back linecolor rgb "#dd9999" dashtype 2
}
file(i) = work."/".word(names, i)
colour(i) = colours[1 + (i - 1) % 12]
bus = folder."/bus.csv"

set title "private memory, MB"
set key inside right center
plot for [i = 1:words(names)] file(i) using 1:2 linewidth 1.5 linecolor rgb colour(i) title word(names, i)
set key inside top right
set title "private memory: change since the warm-up, kB"
set yrange [-20:20 < *]
plot for [i = 1:words(names)] file(i) using 1:3 linewidth 1.5 linecolor rgb colour(i) notitle
set yrange [0:*]
set title "open descriptors"
plot for [i = 1:words(names)] file(i) using 1:4 linewidth 1.5 linecolor rgb colour(i) notitle
set title "minor page faults a second"
plot for [i = 1:words(names)] file(i) using 1:5 linewidth 1 linecolor rgb colour(i) notitle
set title "involuntary switches a second"
plot for [i = 1:words(names)] file(i) using 1:6 linewidth 1 linecolor rgb colour(i) notitle
set title "processor time, percent of a core"
plot for [i = 1:words(names)] file(i) using 1:7 linewidth 1 linecolor rgb colour(i) notitle

set datafile separator ","
set title "chunks of shared memory in use, all pools"
plot bus using ($1 / 60):7 every ::1 linewidth 1.5 linecolor rgb blue notitle
set title "a second: layers, packets / 100"
plot bus using ($1 / 60):2 every ::1 linewidth 1 linecolor rgb blue title "layers", \
     bus using ($1 / 60):($3 / 100) every ::1 linewidth 1 linecolor rgb red title "packets / 100"
set xlabel "minutes"
set title "from a sweep's last packet to its layers, ms, in each second"
set logscale y
set yrange [1:*]
plot bus using ($1 / 60):6 every ::1 linewidth 1 linecolor rgb yellow title "longest", \
     bus using ($1 / 60):5 every ::1 linewidth 1.5 linecolor rgb blue title "median"
unset logscale y
set yrange [0:*]
set title "rounds; losses counted"
set key top left
plot bus using ($1 / 60):8 every ::1 linewidth 1.5 linecolor rgb blue title "rounds", \
     bus using ($1 / 60):9 every ::1 linewidth 1.5 linecolor rgb green title "clean rounds", \
     bus using ($1 / 60):10 every ::1 linewidth 1.5 linecolor rgb red title "lost and counted"
unset multiplot
