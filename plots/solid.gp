# Shared by pictures of bodies: polygons sorted by depth and lit, seen along z, no axes.
set view equal xyz
unset border
unset tics
unset grid
unset colorbox
unset key
set pm3d depthorder
set pm3d lighting primary 0.4 specular 0.1
set pm3d border retrace
# In SVG gnuplot gives borders no fill, which means black; its polygons there need none.
if (format eq "svg") {
    set pm3d noborder
}
first_body = "#9db7d5"
second_body = "#f0c890"
