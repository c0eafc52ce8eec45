# Comments name elements of scene files and escapes, which Doxygen would take for its own.
\|///| {
  s/(^|[^`])<(\/?[a-z_]+)(>|$| )/\1\&lt;\2\3/g
  s/&name;/\&amp;name;/g
  s/\\r/\\\\r/g
}
