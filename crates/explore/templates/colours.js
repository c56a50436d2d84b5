  // Colours the marks by another axis.
  var pick = document.getElementById('pick');
  var legends = all('.by-axis');
  pick.hidden = legends.length === 0;
  pick.querySelector('select').addEventListener('change', function (event) {
    var axis = Number(event.target.value);
    legends.forEach(function (legend, index) { legend.hidden = index !== axis; });
    var colours = {{ colours }};
    var marks = all('.mark[data-g]');
    marks.forEach(function (mark) {
      var group = Number(mark.dataset.g.split(' ')[axis]);
      var best = mark.classList.contains('best');
      mark.setAttribute('class', 'mark k' + (group >= 2 * colours ? colours : group % colours) + (best ? ' best' : '') + (mark.classList.contains('hollow') ? ' hollow' : ''));
      var box = group >= colours ? group !== 2 * colours : false;
      mark.setAttribute('href', '#' + (best ? 'front-' : 'all-') + (box ? 'box' : 'dot'));
    });
    // Marks at the same place with different colours are drawn as rings around each other.
    var above = new Map();
    marks.reverse().forEach(function (mark) {
      var x = mark.getAttribute('x');
      var y = mark.getAttribute('y');
      var place = mark.closest('figure').id + ' ' + x + ' ' + y;
      var look = mark.getAttribute('class') + mark.getAttribute('href');
      var looks = above.get(place) || above.set(place, []).get(place);
      if (!looks.includes(look)) { looks.push(look); }
      var scale = 1 + looks.indexOf(look) / 2;
      mark.style.setProperty('--s', scale);
      mark.setAttribute('transform', 'translate(' + x + ' ' + y + ') scale(' + scale + ') translate(-' + x + ' -' + y + ')');
    });
  });
